// SPDX-License-Identifier: BSL-1.0
// One run. A stepper: what it does, what it refuses, in a bath too, and what noise it draws. integrate():
// what it refuses, when a run is looked at, and when it is given up. The loop allocates nothing, however many
// steps it takes, alone and in lanes. That trajectories side by side go as each would alone, also where one
// diverges, is in data/trajectories_test.cpp.
#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <set>

#include "../laws/compiled_specimens.hpp"
#include "../laws/laws.hpp"
#include "../support/allocations.hpp"
#include "../support/members.hpp"
#include "../support/refusal.hpp"
#include "nysalt/core.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/references/odeint.hpp"

using namespace nysalt;
using namespace nysalt::test;
using nysalt::test::allocations;

namespace {

using point = phase_point<double, 1>;
using state = phase_point<double, Eigen::Dynamic>;

const model swing = pendulum();
const model warm = in_bath(pendulum(), bath::of_sigma(0.3, 0.2));
const model heated = in_bath(pendulum(), bath::of_sigma(0.0, 0.2));
const model cold = in_bath(pendulum(), bath::of_temperature(0.3, 0.0));
const model trivial = in_bath(pendulum(), bath::of_temperature(0.0, 0.7));
const method by_verlet{verlet()};
const method by_baoab{baoab()};
const method by_obabo{obabo()};
const method by_two{baoab_2x()};

point at(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }
state one(double q, double p) { return {Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, p)}; }
state somewhere() { return one(0.7, -0.4); }

template <class Noise = counter_noise>
bool refused(const model& system, const method& method, double step, said words,
             const Noise& noise = Noise(1)) {
  return refuses([&] { make_stepper(system, method, step, noise); }, words);
}
bool refused_without_noise(const model& system, const method& method, said words) {
  return refuses([&] { make_stepper(system, method, 0.1); }, words);
}

/// What 100 steps draw, looked at every so often and at the end.
template <bool DrawsFreely = true>
drawn_noise drawn_by(const model& system, const method& method, std::int64_t every) {
  drawn_noise notes;
  const auto fixed = make_stepper(system, method, 0.1, noted_noise<DrawsFreely>(notes));
  auto run = fixed.open(somewhere(), 3);
  fixed.advance(run, 100, every, [](auto&&...) {});
  return notes;
}

using place = std::tuple<std::uint64_t, std::int64_t, int>;
std::set<place> different(const std::vector<noise_place>& places) {
  std::set<place> all;
  for (const auto& [trajectory, step, flow] : places) all.insert({trajectory, step, flow});
  return all;
}

const auto no_observer = [](auto&&...) {};
const model oscillator = harmonic_oscillator(1.0);
const model chain = fpu_chain<3>(50.0);

/// A force without a potential: q'' = q^3.
struct runaway {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = q[0] * q[0] * q[0]; }
};

/// The first step at which the state runs away, by looking at every one; -1 if none of them does.
std::int64_t first_bad_step(const model& system, const method& method, double step, const state& x,
                            std::int64_t steps) {
  const auto fixed = make_stepper(system, method, step);
  auto run = fixed.open(x);
  double scale = 0.0;
  if (has_energy(system)) {
    auto at_rest = x;
    at_rest.p.setZero();
    const double potential = energy<double>(system, at_rest);
    at_rest.q *= 1.0 + 0x1p-10;
    scale = std::max({std::abs(energy<double>(system, x)), energy<double>(system, x) - potential,
                      1024.0 * std::abs(energy<double>(system, at_rest) - potential)});
  }
  while (run.step < steps) {
    fixed.advance(run, 1);
    const auto y = fixed.synchronous(run);
    if (!is_finite(y)) return run.step;
    if (!has_energy(system)) continue;
    const double before = energy<double>(system, x);
    if (!(std::abs(energy<double>(system, y) - before) <= 1e3 * scale)) return run.step;
  }
  return -1;
}

void gives_up_in_time(const model& system, const method& method, double step, const state& x) {
  const std::int64_t first = first_bad_step(system, method, step, x, 5000);
  BOOST_REQUIRE(first > 0);
  const auto fixed = make_stepper(system, method, step);
  auto run = fixed.open(x);
  fixed.advance(run, first);
  const auto bad = fixed.synchronous(run);
  // Numbers are equal, or no numbers both.
  const auto same = [](const auto& a, const auto& b) {
    return std::ranges::equal(a, b, [](double u, double v) { return u == v || (u != u && v != v); });
  };
  for (const std::int64_t every : {1, 2, 7, 50, 64, 100, 5000}) {
    std::int64_t last_seen = -1;
    const auto observe = [&](std::int64_t n, double, const auto&) { last_seen = n; };
    const auto end = integrate(system, method, step, x, 5000, observe, every);
    BOOST_TEST_CONTEXT("every " << every) {
      BOOST_REQUIRE(end.diverged_at.has_value());
      BOOST_TEST(*end.diverged_at == first);
      BOOST_TEST(end.steps == first);
      BOOST_TEST((same(end.finish.q, bad.q) && same(end.finish.p, bad.p)));
      BOOST_TEST(last_seen == (first - 1) / every * every);  // no observer sees the bad state
    }
  }
}

/// A state of that energy, K = p^2/2 alone.
state with_energy(double energy) { return one(0.0, std::sqrt(2.0 * energy)); }
model in(const bath& heat_bath) { return in_bath(harmonic_oscillator(1.0), heat_bath); }

/// Whether the bound lies at 1e3 times the scale, to a part in a thousand.
bool has_scale(const model& system, double scale, double start = 0.0) {
  detail::divergence diverged(system, with_energy(start));
  return !diverged(with_energy(start + 0.999e3 * scale)) && diverged(with_energy(start + 1.001e3 * scale));
}

template <System S, NoiseSource Noise = no_noise>
std::size_t allocations_of(const S& chain, const method& method, std::int64_t steps,
                           const Noise& noise = {}) {
  const auto stepper = make_stepper(chain, method, 1e-3, noise);
  phase_point<double, S::dimension> start{detail::make_vector<double>(chain),
                                          detail::make_vector<double>(chain)};
  start.q.setConstant(0.7);
  start.p.setConstant(0.1);
  auto run = stepper.open(start);
  const std::size_t before = allocations;
  stepper.advance(run, steps);
  return allocations - before;
}

const fpu_chain<3> fixed(50.0);
const fpu_chain<> dynamic(3, 50.0);

}  // namespace

BOOST_AUTO_TEST_CASE(a_run_from_q_and_p_is_an_open_run_to_the_bit) {
  for (const auto& method : {by_baoab, by_obabo}) {
    const auto fixed = make_stepper(warm, method, 0.1, counter_noise(1));
    const auto run_of = [&](std::uint64_t trajectory, int steps) {
      auto run = fixed.open(somewhere(), trajectory);
      fixed.advance(run, steps);
      return fixed.synchronous(run);
    };
    flow_state<double, Eigen::Dynamic> x{somewhere(), Eigen::VectorXd::Zero(1)};
    auto y = x;
    constexpr std::array after{2, 5};
    std::vector<state> seen;
    fixed.run(x, y, after, 3, [&](std::size_t k) {
      BOOST_TEST(k == seen.size());
      seen.push_back(y);
    });
    BOOST_TEST_REQUIRE(seen.size() == 2U);
    BOOST_TEST(same_bits(seen[0], run_of(3, 2)));
    BOOST_TEST(same_bits(seen[1], run_of(3, 5)));
    BOOST_TEST(!same_bits(seen[1], run_of(2, 5)));
    BOOST_TEST(!same_bits(seen[1], run_of(3, 4)));
  }
}

BOOST_AUTO_TEST_CASE(a_step_is_finite_and_not_zero) {
  for (const double step : {0.0, -0.0, not_a_number, infinite}) {
    BOOST_TEST(refused(swing, by_verlet, step, {"step", "finite and not zero"}, no_noise()));
    BOOST_TEST(refused(warm, by_obabo, step, {"step", "finite and not zero"}));
    const pendulum system;
    BOOST_TEST(refuses([&] { make_stepper(system, verlet(), step); }, {"finite and not zero"}));
  }
  BOOST_TEST(make_stepper(swing, by_verlet, -0.1).step_size() == -0.1);
}

BOOST_AUTO_TEST_CASE(a_bath_that_acts_needs_a_letter_of_the_word_and_noise_a_source) {
  for (const model* system : {&warm, &heated, &cold}) {
    const auto description = system->bath().description();
    BOOST_TEST(refused(*system, by_verlet, 0.1, {description, "BAB", "must have a letter O", "thermostat"}));
    BOOST_TEST(refused_without_noise(*system, by_verlet, {"must have a letter O"}));
    for (const auto& method : {by_baoab, by_obabo}) {
      BOOST_TEST(!refused(*system, method, 0.1, {}));
      const bool is_noisy = system != &cold;
      const said why{is_noisy ? description.c_str() : "", "must have a source of noise",
                     "counter_noise(seed)"};
      BOOST_TEST(refused_without_noise(*system, method, why) == is_noisy);
    }
  }
  for (const auto& method : {by_baoab, by_obabo, by_verlet}) {
    BOOST_TEST(!refused(trivial, method, 0.1, {}));
    BOOST_TEST(!refused_without_noise(trivial, method, {}));
  }
  BOOST_TEST(!refused_without_noise(warm.base(), by_baoab, {}));  // the system without its bath
}

BOOST_AUTO_TEST_CASE(noise_does_not_go_back_in_time_but_damping_does) {
  for (const model* system : {&warm, &heated}) {
    BOOST_TEST(refused(*system, by_baoab, -0.1, {"letter O", "back in time", "-0.1"}));
  }
  BOOST_TEST(!refused(trivial, by_baoab, -0.1, {}));
  // A palindrome's step back undoes its step; some ten operations on numbers of size one, twice.
  for (const auto& method : {by_baoab, by_obabo, nysalt::method(aboba())}) {
    auto x = somewhere();
    make_stepper(cold, method, 0.1).step(x);
    BOOST_TEST(distance(x, somewhere()) > 0.01);
    make_stepper(cold, method, -0.1).step(x);
    BOOST_TEST(distance(x, somewhere()) <= 20.0 * eps);
  }
}

BOOST_AUTO_TEST_CASE(each_letter_has_a_coefficient_whatever_the_bath) {
  for (const std::size_t count : {0U, 3U, 4U, 6U}) {
    const std::string got = fmt::format("{} coefficients", count);
    for (const model& system : {warm, trivial, warm.base()}) {
      const auto make = [&] {
        stepper<model, double, counter_noise>(system, word("OBABO"), std::vector<double>(count, 0.5), 0.1,
                                              counter_noise(1));
      };
      BOOST_TEST(refuses(make, {"OBABO", "5 letters", got}));
    }
  }
}

// A letter O draws its numbers once a step; halves that meet draw one for both, and the other when looked at.
// Each letter of each step has numbers of its own.
BOOST_AUTO_TEST_CASE(noise_is_drawn_once) {
  const auto places_of = [](const drawn_noise& drawn, int last_letter) {
    const auto places = different(drawn.normals);
    BOOST_TEST((*places.begin() == place{3, 0, 0}));
    BOOST_TEST((*places.rbegin() == place{3, 99, last_letter}));
    return places.size();
  };
  const auto drew = [](const drawn_noise& drawn, std::size_t normals, std::size_t halves) {
    return drawn.normals.size() == normals && drawn.halves.size() == halves;
  };
  const method mine("mine", word("OAOBO"), {0.25, 1.0, 0.5, 1.0, 0.25}, {1, false, false});
  for (const std::int64_t every : {1, 1000}) {
    BOOST_TEST(drew(drawn_by(warm, by_baoab, every), 100, 0));
    BOOST_TEST(drew(drawn_by<false>(warm, by_baoab, every), 100, 0));
    BOOST_TEST(places_of(drawn_by(warm, by_baoab, every), 0) == 100U);
    BOOST_TEST(drew(drawn_by(warm, by_two, every), 200, 0));
    BOOST_TEST(places_of(drawn_by(warm, by_two, every), 1) == 200U);
    for (const model* system : {&cold, &trivial}) {
      for (const auto& method : {by_baoab, by_obabo, by_two})
        BOOST_TEST(drew(drawn_by(*system, method, every), 0, 0));
    }
  }
  // Of the halves the first step has only one; of a path the last half is still to come.
  BOOST_TEST(drew(drawn_by(warm, by_obabo, 1000), 100, 1));
  BOOST_TEST(drew(drawn_by(warm, by_obabo, 10), 100 + 10, 1 + 10));
  BOOST_TEST(drawn_by<false>(warm, by_obabo, 1000).normals.size() == 199U);
  BOOST_TEST(places_of(drawn_by(warm, by_obabo, 1000), 0) == 100U);
  BOOST_TEST(places_of(drawn_by<false>(warm, by_obabo, 1), 1) == 200U);
  BOOST_TEST(places_of(drawn_by(warm, mine, 1000), 1) == 200U);
}

BOOST_AUTO_TEST_CASE(looking_at_a_run_draws_for_the_look_alone) {
  drawn_noise notes;
  const auto fixed = make_stepper(warm, by_obabo, 0.1, noted_noise<true>(notes));
  auto run = fixed.open(somewhere());
  BOOST_TEST((same_bits(fixed.synchronous(run), somewhere())));  // at the start there is no noise
  BOOST_TEST(notes.normals.empty());
  fixed.advance(run, 5);
  notes = {};
  const auto once = fixed.synchronous(run);
  BOOST_TEST(notes.halves.size() == 1U);
  BOOST_TEST(notes.halves.front().step == 5);
  BOOST_TEST((same_bits(fixed.synchronous(run), once)));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const pendulum system;
  const auto refused = [&](const point& x, std::int64_t steps, std::int64_t every, said words) {
    return refuses([&] { integrate(system, verlet(), 0.1, x, steps, no_observer, every); }, words);
  };
  BOOST_TEST(refused(at(0, 0), -1, 1, {"integrate", "steps -1"}));
  BOOST_TEST(refused(at(0, 0), 10, 0, {"integrate", "every 0"}));
  BOOST_TEST(refused(at(0, 0), 10, -3, {"integrate", "every -3"}));
  BOOST_TEST(refused(at(not_a_number, 0), 10, 1, {"start", "finite", "dimension"}));
  BOOST_TEST(refuses([&] { integrate(system, verlet(), 0.0, at(0, 0), 1); }, {"step", "not zero"}));
  for (const Eigen::Index of_p : {5, 6}) {
    const state misfit{Eigen::VectorXd::Zero(5), Eigen::VectorXd::Zero(of_p)};
    BOOST_TEST(refuses([&] { integrate(chain, by_verlet, 0.1, misfit, 1); }, {"dimension"}));
  }
}

BOOST_AUTO_TEST_CASE(no_steps_end_where_they_start) {
  const auto end = integrate(pendulum(), verlet(), 0.1, at(1, 2), 0);
  BOOST_TEST(end.steps == 0);
  BOOST_TEST(!end.diverged_at.has_value());
  BOOST_TEST(distance(end.finish, at(1, 2)) <= 2.0 * eps);  // the first letter is taken back, to rounding
}

BOOST_AUTO_TEST_CASE(the_observer_is_called_every_so_often_with_the_synchronous_state) {
  const pendulum system;
  const auto fixed = make_stepper(system, verlet(), 0.1);
  std::vector<std::int64_t> seen;
  auto run = fixed.open(at(1, 0));
  const auto observe = [&](std::int64_t n, double t, const point& x) {
    seen.push_back(n);
    BOOST_TEST(t == static_cast<double>(n) * 0.1);
    if (n > 0) fixed.advance(run, n - run.step);
    BOOST_TEST(same_bits(x, n == 0 ? at(1, 0) : fixed.synchronous(run)));  // first the start itself
  };
  const auto end = integrate(system, verlet(), 0.1, at(1, 0), 200, observe, 75);
  BOOST_TEST((seen == std::vector<std::int64_t>{0, 75, 150}));
  BOOST_TEST(end.steps == 200);
  fixed.advance(run, 50);
  BOOST_TEST(same_bits(end.finish, fixed.synchronous(run)));
}

BOOST_AUTO_TEST_CASE(divergence_is_named_by_its_first_step_whoever_looks) {
  gives_up_in_time(oscillator, by_verlet, 2.001, one(1, 0));  // by its energy
  gives_up_in_time(chain, by_verlet, 0.05, {Eigen::VectorXd::Constant(6, 0.1), Eigen::VectorXd::Ones(6)});
  gives_up_in_time(runaway(), by_verlet, 0.1, one(1, 1));  // without an energy, by what is not finite
  BOOST_TEST(first_bad_step(oscillator, by_verlet, 1.99, one(1, 0), 5000) == -1);
  BOOST_TEST(!integrate(oscillator, by_verlet, 1.99, one(1, 0), 5000).diverged_at.has_value());
  // Just inside Verlet's limit the energy swings by more than 1e3 and comes back.
  const auto unobserved = integrate(oscillator, by_verlet, 1.9991, one(0, 2), 10000);
  BOOST_TEST(first_bad_step(oscillator, by_verlet, 1.9991, one(0, 2), 10000) > 0);
  for (const std::int64_t every : {1, 50, 64, 100, 10000}) {
    const auto end = integrate(oscillator, by_verlet, 1.9991, one(0, 2), 10000, no_observer, every);
    BOOST_TEST((end.diverged_at == unobserved.diverged_at));
    BOOST_TEST(same_bits(end.finish, unobserved.finish));
  }
}

BOOST_AUTO_TEST_CASE(the_scale_of_divergence_is_the_energy_at_the_start_or_that_of_the_bath) {
  BOOST_TEST(has_scale(oscillator, 1.0, 1.0));
  BOOST_TEST(has_scale(oscillator, 1e-18, 1e-18));  // no energy is large or small by itself
  BOOST_TEST(has_scale(oscillator, 7.0, 7.0));
  BOOST_TEST(!has_scale(oscillator, 7.0));
  BOOST_TEST(has_scale(in(bath::of_temperature(0.1, 5.0)), 5.0));
  BOOST_TEST(has_scale(in(bath::of_temperature(0.1, 5.0)), 7.0, 7.0));
  BOOST_TEST(has_scale(in(bath::of_temperature(0.1, 0.2)), 0.2));
  BOOST_TEST(has_scale(in(bath::of_sigma(0.5, 3.0)), 9.0));  // kT = sigma^2/(2 gamma)
  BOOST_TEST(!has_scale(in(bath::of_temperature(0.1, 5.0)), 1.0));
  BOOST_TEST(has_scale(in(bath::of_sigma(0.0, 0.0)), 7.0, 7.0));  // what does not act changes nothing
  BOOST_TEST(has_scale(in(bath::of_sigma(0.1, 0.0)), 7.0, 7.0));
  detail::divergence at_rest(oscillator,
                             with_energy(0.0));  // nothing has a scale: only what is not finite is lost
  BOOST_TEST(!at_rest(with_energy(1e100)));
  BOOST_TEST(at_rest.last_change() == 1e100, tolerance(1e-12));
  BOOST_TEST(at_rest(one(std::nan(""), 1.0)));
  const model many = in_bath(dynamic_potential{.masses = 4}, bath::of_temperature(0.1, 5.0));
  const auto moving = [](double p) {
    return state{Eigen::VectorXd::Zero(4), Eigen::VectorXd::Constant(4, p)};
  };
  detail::divergence diverged(many, moving(0.0));  // 4 p^2/2 against 1e3 4 kT
  BOOST_TEST(!diverged(moving(std::sqrt(0.999e3 * 10.0))));
  BOOST_TEST(diverged(moving(std::sqrt(1.001e3 * 10.0))));
}

BOOST_AUTO_TEST_CASE(each_lane_has_its_own_bound) {
  using T = pack<double, 2>;
  const auto both_at = [](double first, double second) {
    auto x = with_energy(first).cast<T>();
    detail::set_lane(x, 1, with_energy(second));
    return x;
  };
  const model warm = in(bath::of_temperature(0.1, 5.0));
  detail::divergence<model, T> diverged(warm, both_at(0.0, 7.0));
  const auto found = diverged(both_at(6000.0, 6000.0));
  BOOST_TEST(found[0]);
  BOOST_TEST(!found[1]);
}

// Noise without friction: the energy grows for ever, and rightly so. Only what is not finite is lost.
BOOST_AUTO_TEST_CASE(a_bath_that_heats_has_no_bound) {
  const model heated = in(bath::of_sigma(0.0, 1.0));
  detail::divergence diverged(heated, with_energy(0.0));
  BOOST_TEST(!diverged(with_energy(1e100)));
  for (const double bad : {infinite, std::nan("")}) {
    BOOST_TEST(diverged(one(bad, 1.0)));
  }
}

BOOST_AUTO_TEST_CASE(any_system_goes_in_lanes) {
  draws random;
  for (const specimen& one : specimens_with([](const model& system) { return system.facts().in_lanes; })) {
    for (const auto& method : {by_verlet, nysalt::method(srkn6b())}) {
      const run_of run{one.system, method, 0.02};
      BOOST_TEST(run.lanes_are_alone(one, random), describe(one.system) << ", " << method.name());
    }
  }
  const auto& galaxy = specimen_of("henon_heiles");
  BOOST_TEST(!(run_of{galaxy.system, by_verlet, 0.02}).lanes_are_alone(galaxy, random, 32));  // a step apart
}

// Within Boost.Odeint's loops our methods give our states.
BOOST_AUTO_TEST_CASE(the_loops_of_odeint_see_our_states) {
  namespace odeint = boost::numeric::odeint;
  const henon_heiles galaxy;
  const auto start = draws().state(galaxy, 0.2);
  constexpr double h = 0.1;
  constexpr std::size_t steps = 100;
  using states = std::vector<phase_point<double, 2>>;
  const auto check = [&](const auto& method) {
    states ours;
    integrate(galaxy, method, h, start, steps,
              [&](std::int64_t, double, const auto& x) { ours.push_back(x); });
    // Each letter rounds twice in each of the steps; on a bounded regular orbit |J| grows with t, to some 2
    // t.
    const double rounding = steps * 4.0 * roundings(method, 2) * eps * 2.0 * h * steps;
    states theirs;
    double last_time = 0.0;
    const auto observe = [&](const phase_point<double, 2>& x, double t) {
      theirs.push_back(x);
      last_time = t;
    };
    const auto agrees = [&](const auto& x) {
      BOOST_REQUIRE(theirs.size() == ours.size());
      for (std::size_t n = 0; n < ours.size(); ++n) BOOST_TEST(distance(theirs[n], ours[n]) <= rounding);
      BOOST_TEST(same_bits(theirs.back(), x));
      BOOST_TEST(distance(x, ours.front()) > 1e-3);  // it moved
      theirs.clear();
    };
    auto x = start;
    odeint::integrate_const(odeint_stepper(method), galaxy, x, 0.0, h * steps, h, observe);
    BOOST_TEST(std::abs(last_time - 10.0) <= 10.0 * eps);  // the last point is there
    agrees(x);
    x = start;
    odeint::integrate_n_steps(odeint_stepper(method), galaxy, x, 0.0, h, steps, observe);
    agrees(x);
  };
  check(by_verlet);
  check(nysalt::method(takahashi_imada()));
  check(srkn6b());  // a row of the table of classical methods
  BOOST_TEST(odeint_stepper(verlet()).order() == 2);
  BOOST_TEST(odeint_stepper(srkn11b()).order() == 6);
}

BOOST_AUTO_TEST_CASE(the_count_sees_an_allocation) {
  const std::size_t before = allocations;
  const Eigen::VectorXd something(8);
  BOOST_TEST(allocations - before == 1U);
  BOOST_TEST(something.size() == 8);
}

// Letters that need more than the state have four vectors of a dynamic size.
BOOST_AUTO_TEST_CASE(the_loop_allocates_nothing) {
  const auto linear = linear_chain::between_walls(6, 4.0);
  BOOST_TEST(allocations_of(dynamic, start_of<nystrom>(), 1000) == 0U);
  BOOST_TEST(allocations_of(fixed, start_of<fg4>(), 1000) == 0U);
  BOOST_TEST(allocations_of(dynamic, start_of<fg4>(), 1000) == 4U);
  BOOST_TEST(allocations_of(linear, start_of<r_aba<4>>(), 1000) == 4U);
  BOOST_TEST(allocations_of(linear, start_of<r_aba<4>>(), 1) == 4U);
  for (const Eigen::Index pairs : {70, 600}) {  // tiles have a few buffers
    const model chain(fpu_chain<>(pairs, 50.0));
    const auto of_few = allocations_of(chain, method(verlet{}), 5000);
    BOOST_TEST(of_few < 40U);
    BOOST_TEST(allocations_of(chain, method(verlet{}), 10000) == of_few);
  }
}

// Of a dynamic size the noise has one vector.
BOOST_AUTO_TEST_CASE(the_noisy_loop_allocates_nothing) {
  const in_bath warm(fixed, bath::of_sigma(0.1, 0.05));
  const in_bath warm_and_dynamic(dynamic, bath::of_sigma(0.1, 0.05));
  const in_bath cold(fixed, bath::of_sigma(0.1, 0.0));
  const counter_noise noise(1);
  BOOST_TEST(allocations_of(warm, method(obabo{}), 1000, noise) == 0U);
  BOOST_TEST(allocations_of(cold, method(obabo{}), 1000) == 0U);
  BOOST_TEST(allocations_of(warm_and_dynamic, baoab(), 1000, noise) == 1U);
  BOOST_TEST(allocations_of(warm_and_dynamic, method(obabo{}), 2, noise) ==
             allocations_of(warm_and_dynamic, method(obabo{}), 1000, noise));
}

// A thousand steps, watched at each: what is allocated is allocated before.
BOOST_AUTO_TEST_CASE(the_loop_in_lanes_allocates_nothing) {
  using T = pack<double, 8>;
  const auto stepper = make_stepper(fixed, verlet(), .01);
  const auto start = detail::sound_starts<T>(fixed, fpu_law<3>(fixed), 1, 0, 8);
  detail::lockstep<decltype(stepper), T> all(stepper, start, 8);
  struct sum_of_energies {
    T sum{0.0};
    static std::size_t width() { return 1; }
    static void read(const phase_point<T, 6>& x, std::span<T> numbers) { numbers[0] = fixed.stiff_energy(x); }
    void see(std::int64_t, std::span<const T> numbers, const detail::condition_of<T>&) { sum += numbers[0]; }
  } measure;
  all.go_on(64, 1, measure);  // finds its room
  const auto before = allocations;
  all.go_on(1064, 1, measure);
  BOOST_TEST(allocations == before);
  BOOST_TEST(measure.sum[7] > 0.0);
}

// But where a list is made: not at rest, and once in a while in motion.
BOOST_AUTO_TEST_CASE(a_liquid_allocates_where_its_list_is_made) {
  const auto allocations_at = [](double temperature, std::int64_t steps) {
    const lennard_jones_liquid liquid(256, 0.8442);
    const auto stepper = make_stepper(liquid, verlet{}, 0.004);
    auto run = stepper.open(lennard_jones_liquid_law(liquid, temperature)(1, 0));
    stepper.advance(run, 1);
    const std::size_t before = allocations;
    const std::int64_t made = liquid.lists_made();
    stepper.advance(run, steps);
    return std::pair(allocations - before, liquid.lists_made() - made);
  };
  const auto [at_rest, lists] = allocations_at(0.0, 100);
  BOOST_TEST(at_rest == 0U);
  BOOST_TEST(lists == 0);
  BOOST_TEST(allocations_at(3.0, 100).second > 0);
}
