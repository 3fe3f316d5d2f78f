// SPDX-License-Identifier: BSL-1.0
// Accuracy and cost of runs: the energy error of a symplectic method is bounded and has no trend, and that of
// any other grows; errors at a horizon fall with the step by the order of the method; how long trajectories
// can be predicted; force evaluations follow from the first two steps, and jobs that are timed take turns.
#include <chrono>
#include <thread>

#include "../support/allocations.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The galaxy with a force that is a gradient, or is not, as a torque turns it.
struct galaxy_with_torque : henon_heiles {
  double torque = 0.0;
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    henon_heiles::force(q, f);
    f[0] = f[0] - q[1] * torque;
    f[1] += q[0] * torque;
  }
};
const galaxy_with_torque galaxy;
const galaxy_with_torque twisted{{}, 1e-3};
const phase_point<double, 2> star{{0.1, 0.2}, {0.25, -0.1}};

/// On the oscillator of frequency 2.
energy_record drift_of_oscillator(double step, double q, std::int64_t steps) {
  const phase_point<double, 1> x{vector<double, 1>(q), vector<double, 1>(0.0)};
  return energy_drift(harmonic_oscillator(2.0), verlet(), step, x, steps);
}

const model swing{pendulum()};
const phase_point<double, Eigen::Dynamic> start{Eigen::VectorXd::Constant(1, 1.0),
                                                Eigen::VectorXd::Constant(1, 0.5)};

order_measurement measure(const method& method, const reference& accurate, std::int64_t fewest,
                          int halvings) {
  return convergence_order(swing, method, accurate, start, 4.0, fewest, halvings);
}

const method by_verlet{verlet()};
/// A mistake in Verlet: the kick is a little too weak, which is not even consistent.
const method weak_kick("weak_kick", word("BAB"), {0.499, 1.0, 0.499}, {2, true, false});

const in_bath warm(henon_heiles(), bath::of_sigma(0.5, 0.1));

using planar = phase_point<double, 2>;
const harmonic_oscillator oscillator(3.0);
const henon_heiles well;

/// Near the energy 1/6 nearly all orbits are chaotic; far below it nearly none.
planar of_energy(double energy) {
  planar x{{0.0, 0.04}, {0.0, 0.0}};
  const double speed = std::sqrt(2.0 * (energy - well.potential<double>(x.q)));
  x.p = {speed * std::cos(0.8), speed * std::sin(0.8)};
  return x;
}

constexpr double interval = 0.25;
const auto flow = fine_steps(interval);
const model of_well(well);

/// The flow over an interval.
void advance(planar& x) { flow.advance(of_well, x, interval); }

double horizon(const planar& start, double perturbation) {
  const trajectory_options options{
      .step = interval, .steps = 1600, .trajectories = 1, .perturbation = perturbation};
  const auto result =
      trajectory_errors(well, flow, listed<2>({start}), verlet(), state_measure(well), options);
  return result.predictable_until.value();
}

double squared_distance(const planar& a, const planar& b) {
  return (a.q - b.q).squaredNorm() + (a.p - b.p).squaredNorm();
}

}  // namespace

BOOST_AUTO_TEST_CASE(symplectic_means_bounded_and_without_a_trend) {
  constexpr double step = 0.1;
  const auto shorter = energy_drift(galaxy, verlet(), step, star, 5'000);
  const auto longer = energy_drift(galaxy, verlet(), step, star, 50'000);
  BOOST_TEST(!longer.diverged_at.has_value());
  BOOST_TEST(shorter.largest > 0.0);
  BOOST_TEST(longer.largest < 2.0 * shorter.largest);  // ten times as long, and the same bound
  // A bounded oscillation of amplitude A over N >> 1 cycles has a slope of at most A/(N cycles) per cycle:
  // over the whole time T less than A.
  BOOST_TEST(std::abs(longer.drift) * 5'000.0 < longer.largest);
  const auto drifting = energy_drift(twisted, verlet(), step, star, 5'000);
  BOOST_TEST(std::abs(drifting.drift) * 500.0 > 0.5 * drifting.largest);
  BOOST_TEST(drifting.largest > 5.0 * shorter.largest);
}

// On the oscillator Verlet conserves p^2 + w^2 (1 - z^2/4) q^2, so that |H - H_0| is z^2/8 w^2 q^2 at most.
BOOST_AUTO_TEST_CASE(the_largest_error_is_known_on_the_oscillator) {
  const double largest = drift_of_oscillator(0.1, 1.0, 100'000).largest;
  BOOST_TEST(largest <= 0.04 / 4.0 * (1.0 + 1e-9));
  BOOST_TEST(largest == 0.04 / 4.0, tolerance(1e-4));  // some step is near the extremum
  BOOST_TEST(drift_of_oscillator(1.01, 1.0, 10'000).diverged_at.has_value());
  BOOST_TEST(!drift_of_oscillator(0.99, 1.0, 10'000).diverged_at.has_value());
  // At the bottom of the well H_0 is 0, and errors are absolute.
  BOOST_TEST(drift_of_oscillator(0.1, 0.0, 100).largest == 0.0);
  BOOST_TEST(drift_of_oscillator(0.1, 0.0, 100).drift == 0.0);
  // Looking seldom sees less.
  const auto seldom = energy_drift(galaxy, verlet(), 0.1, star, 1000, 50);
  BOOST_TEST(seldom.largest <= energy_drift(galaxy, verlet(), 0.1, star, 1000).largest);
  BOOST_TEST(seldom.largest > 0.0);
}

BOOST_AUTO_TEST_CASE(the_drift_is_the_slope_of_least_squares) {
  const auto compare = [](const auto& system, std::int64_t steps, std::int64_t every) {
    std::vector<double> times;
    std::vector<double> errors;
    const double initial = energy<double>(system, star);
    const auto keep = [&](std::int64_t, double t, const auto& x) {
      times.push_back(t);
      errors.push_back((energy<double>(system, x) - initial) / std::abs(initial));
    };
    integrate(system, verlet(), 0.1, star, steps, keep, every);
    const auto record = energy_drift(system, verlet(), 0.1, star, steps, every);
    // Each of n sums rounds once: n eps of the largest error, over a time T.
    const auto n = static_cast<double>(times.size());
    BOOST_TEST(std::abs(record.drift - slope(times, errors)) <=
               8.0 * n * eps * record.largest / times.back());
    BOOST_TEST(record.drift != 0.0);
  };
  compare(galaxy, 20'000, 1);
  compare(galaxy, 20'000, 7);
  compare(twisted, 5'000, 1);
  compare(twisted, 1, 1);
  BOOST_TEST(energy_drift(galaxy, verlet(), 0.1, star, 5, 10).drift == 0.0);  // one sample has no trend
}

BOOST_AUTO_TEST_CASE(long_runs_need_no_more_memory) {
  const auto allocations_of = [](std::int64_t steps) {
    const std::size_t before = allocations;
    BOOST_TEST(energy_drift(galaxy, verlet(), 0.1, star, steps).largest > 0.0);
    return allocations - before;
  };
  const std::size_t of_short = allocations_of(10);  // of the method and its stepper
  BOOST_TEST(allocations_of(10'000) == of_short);
  BOOST_TEST(of_short > 0U);  // the count would see more
}

// The steps are so small that the next even power of them adds less than a tenth to the error of the first:
// log2(1.1) < .15.
BOOST_AUTO_TEST_CASE(orders_are_those_of_the_methods) {
  const auto order = [](const method& method, std::int64_t fewest, int halvings, double fine_step = 1e-2) {
    return measure(method, fine_steps(fine_step), fewest, halvings).order;
  };
  BOOST_TEST(std::abs(order(by_verlet, 16, 5) - 2.0) < 0.15);
  BOOST_TEST(std::abs(order(nysalt::method(pefrl()), 16, 4) - 4.0) < 0.15);
  BOOST_TEST(std::abs(order(nysalt::method(srkn11b()), 8, 3, 2.5e-3) - 6.0) < 0.15);
  BOOST_TEST(order(weak_kick, 16, 5) < 1.0);
  // Steps in the noise do not count, but those above it do; where all are, what is left is no order.
  const auto result = measure(nysalt::method(srkn6b()), fine_steps(1e-2), 32, 10);
  BOOST_TEST(result.errors.back() < 1e-11);
  BOOST_TEST(std::abs(result.order - 4.0) < 0.15);
  BOOST_TEST(std::isnan(measure(by_verlet, fine_steps(0.125, by_verlet), 32, 4).order));
  BOOST_TEST(std::isnan(order(nysalt::method(srkn11b()), 4000, 3, 1e-3)));  // rounding alone
  BOOST_TEST(std::isnan(order(by_verlet, 16, 0)));                          // a single step
}

BOOST_AUTO_TEST_CASE(steps_are_halved_and_errors_measured_at_the_horizon) {
  const auto result = measure(by_verlet, fine_steps(1e-2), 16, 3);
  BOOST_TEST(result.steps == (std::vector<double>{0.25, 0.125, 0.0625, 0.03125}), per_element());
  BOOST_REQUIRE(result.errors.size() == 4);
  auto exact = start;
  fine_steps(1e-2).advance(swing, exact, 4.0);
  const auto end = integrate(swing, by_verlet, 0.0625, start, 64).finish;
  BOOST_TEST(result.errors[2] == distance(end, exact), tolerance(1e-12));
}

// Large steps run away; the order is that of those which do not.
BOOST_AUTO_TEST_CASE(what_diverged_has_no_error_and_no_part_in_the_order) {
  const phase_point<double, Eigen::Dynamic> x{Eigen::Vector2d(0.1, 0.2), Eigen::Vector2d(0.25, -0.1)};
  const model stars{henon_heiles()};
  const auto result = convergence_order(stars, by_verlet, fine_steps(1e-2), x, 40.0, 10, 9);
  BOOST_REQUIRE(result.errors.size() == 10);
  BOOST_REQUIRE(result.steps.size() == 10);
  BOOST_REQUIRE(integrate(stars, by_verlet, 4.0, x, 10).diverged_at.has_value());
  BOOST_TEST(result.errors[0] == std::numeric_limits<double>::infinity());
  BOOST_TEST(result.errors[9] < 1e-3);
  // Of the eight steps that remain only the two largest are off their power, by less than a third.
  BOOST_TEST(std::abs(result.order - 2.0) < 0.15);
}

BOOST_AUTO_TEST_CASE(steps_and_halvings_that_cannot_be_are_refused) {
  const auto refused = [](double horizon, std::int64_t fewest, int halvings, std::string_view words) {
    return refuses(
        [&] { convergence_order(swing, by_verlet, fine_steps(1e-2), start, horizon, fewest, halvings); },
        {"convergence_order", words});
  };
  BOOST_TEST(refused(4.0, 0, 3, "got 0,"));
  BOOST_TEST(refused(4.0, -4, 3, "got -4,"));
  BOOST_TEST(refused(4.0, 16, -1, ", -1 and"));
  BOOST_TEST(refused(0.0, 4, 2, "horizon"));
  BOOST_TEST(refused(std::nan(""), 4, 2, "horizon"));
}

// By the costs of the word, which are counted in methods/laws_test.cpp.
BOOST_AUTO_TEST_CASE(evaluations_of_a_run_are_known_without_its_steps) {
  BOOST_TEST(evaluations_of_run(warm, baoab(), 0.1, 1'000'000'000'000, star) == 1'000'000'000'001);
  const auto refused = [](const auto& method, double step, std::int64_t steps) {
    return refuses([&] { evaluations_of_run(warm, method, step, steps, star); }, {});
  };
  BOOST_TEST(!refused(baoab(), 0.1, 5));
  BOOST_TEST(refused(baoab(), 0.0, 5));
  BOOST_TEST(refused(baoab(), 0.1, -5));
  BOOST_TEST(refused(verlet(), 0.1, 5));  // no letter O
}

BOOST_AUTO_TEST_CASE(jobs_take_turns_and_run_once_more_than_they_are_timed) {
  std::string order;
  const auto timed = interleaved_seconds({[&] { order += 'a'; }, [&] { order += 'b'; }}, 3);
  BOOST_TEST(order == "abababab");
  BOOST_TEST(timed.size() == 2);
  for (const timed_job& job : timed) {
    BOOST_TEST(job.rounds == 3);
    BOOST_TEST(job.least >= 0.0);
    BOOST_TEST(job.median >= job.least);
  }
  BOOST_TEST(interleaved_seconds({}, 3).empty());
  const timed_job untimed = interleaved_seconds({[] {}}, 0).front();
  BOOST_TEST(untimed.rounds == 0);
  BOOST_TEST(std::isinf(untimed.least));
  BOOST_TEST(std::isnan(untimed.median));
}

// Of the first job the first round, which is not timed, is slow; of the second each; of the third two of
// three, whose median is theirs.
BOOST_AUTO_TEST_CASE(a_longer_job_takes_longer_and_an_interruption_does_not_count) {
  const auto slow_in = [](std::vector<bool> rounds) {
    return [rounds, n = std::size_t{0}]() mutable {
      if (rounds.at(n++)) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    };
  };
  const auto timed =
      interleaved_seconds({slow_in({true, false, false, false}), slow_in({true, true, true, true}),
                           slow_in({true, true, false, true})},
                          3);
  BOOST_TEST(timed[0].median < 0.05);
  BOOST_TEST(timed[1].least >= 0.05);
  BOOST_TEST(timed[2].least < 0.05);
  BOOST_TEST(timed[2].median >= 0.05);
}

// States turn by w t: e^2 = 2 H |1 - exp(i w t)|^2 = 4 H (1 - cos w t).
BOOST_AUTO_TEST_CASE(an_oscillator_that_stays_has_the_error_of_its_turn) {
  const gibbs_of_modes<1> law(oscillator, 1.0);
  const trajectory_options options{.step = .1, .steps = 70, .trajectories = 30, .null_model = true};
  double expected = 0.0;
  for (std::uint64_t m = 0; m < 30; ++m) {
    for (int n = 1; n <= 70; ++n) {
      expected += 4.0 * energy<double>(oscillator, law(1, m)) * (1.0 - std::cos(.3 * n)) / (30.0 * 70.0);
    }
  }
  const auto result = trajectory_errors(oscillator, exact_linear(oscillator), law, verlet(),
                                        state_measure(oscillator), options);
  // Each of 70 turns rounds some ten times.
  BOOST_TEST(result.null_model.value().mean == std::sqrt(expected), tolerance(700 * eps));
  BOOST_TEST(result.null_model.value().standard_error > 0.0);
  BOOST_TEST(result.methods[0].error.mean < 0.5 * result.null_model->mean);
  BOOST_TEST(!result.predictable_until.has_value());
}

/// The definition once more, over one trajectory, with what measures say of single states.
BOOST_AUTO_TEST_CASE(the_horizon_is_where_the_sums_cross) {
  const planar start = of_energy(0.165);
  planar x = start;
  planar y = detail::perturbed(start, 1e-3, 1, 0);
  double perturbed_sum = 0.0;
  double null_sum = 0.0;
  double expected = 0.0;
  for (int n = 1; n <= 1600; ++n) {
    advance(x);
    advance(y);
    perturbed_sum += squared_distance(x, y);
    null_sum += squared_distance(x, start);
    if (perturbed_sum <= 0.25 * null_sum) expected = (n + 1) * interval;
  }
  BOOST_TEST(horizon(start, 1e-3) == expected);
  BOOST_TEST(horizon(start, 1e-6) > expected);  // chaos ends predictability earlier for larger perturbations
  BOOST_TEST(std::isfinite(horizon(start, 1e-6)));
  BOOST_TEST(std::isinf(horizon(of_energy(0.03), 1e-3)));
}

// With noise of its own the perturbed run would be elsewhere after 1/friction = 2.
BOOST_AUTO_TEST_CASE(in_a_bath_the_noise_is_common) {
  const model warm = model(oscillator).in(bath::of_sigma(0.5, 1.0));
  const initial_states law = normal_around<1>({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.3, 1.0);
  const trajectory_options options{.step = .1, .steps = 200, .trajectories = 20, .perturbation = 1e-3};
  const auto result =
      trajectory_errors(warm, fine_paths(.05), law, method(baoab()), state_measure(warm), options);
  BOOST_TEST(std::isinf(result.predictable_until.value()));
}

BOOST_AUTO_TEST_CASE(samples_count_from_where_the_errors_stay_above) {
  detail::predictable_samples<double> squares(averaging::root_of_all);
  detail::predictable_samples<double> moduli(averaging::mean);
  const std::array<double, 5> sums{1.0, 2.0, 3.0, 4.0, NAN};
  const std::array<double, 5> null_sums{0.0, 8.0, 8.0, 8.0, 8.0};
  std::vector<double> of_squares;
  std::vector<double> of_moduli;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    squares.add(static_cast<std::int64_t>(i) + 1, sums[i], null_sums[i]);
    moduli.add(static_cast<std::int64_t>(i) + 1, sums[i], null_sums[i]);
    of_squares.push_back(squares.until(0));
    of_moduli.push_back(moduli.until(0));
  }
  BOOST_TEST(of_squares == (std::vector<double>{1.0, INFINITY, 3.0, 3.0, 3.0}));
  BOOST_TEST(of_moduli == (std::vector<double>{1.0, INFINITY, INFINITY, INFINITY, 5.0}));
}

// By normal numbers of their own, those of q before those of p.
BOOST_AUTO_TEST_CASE(perturbations_are_relative_and_independent) {
  const planar x{{2.0, 0.0}, {-1e-3, 1e3}};
  Eigen::Vector4d z;
  standard_normals(1, {.trajectory = 7, .purpose = noise_purpose::perturbation}, z);
  const planar y = detail::perturbed(x, 0.01, 1, 7);
  const auto near = tolerance(4.0 * eps);
  BOOST_TEST(y.q[0] == 2.0 * (1.0 + 0.01 * z[0]), near);
  BOOST_TEST(y.q[1] == 0.0);
  BOOST_TEST(y.p[0] == -1e-3 * (1.0 + 0.01 * z[2]), near);
  BOOST_TEST(y.p[1] == 1e3 * (1.0 + 0.01 * z[3]), near);
  BOOST_TEST(detail::perturbed(x, 0.01, 1, 0).q[0] != detail::perturbed(x, 0.01, 2, 0).q[0]);
  // Not with the numbers of a start: else what is far out would move far.
  const normal_around<2> law({{1.0, 1.0}, {1.0, 1.0}}, 0.01, 0.01);
  const planar ones{{1.0, 1.0}, {1.0, 1.0}};
  BOOST_TEST(detail::perturbed(ones, 0.01, 1, 5).q[0] != law(1, 5).q[0]);
}
