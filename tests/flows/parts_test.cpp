// SPDX-License-Identifier: BSL-1.0
// Systems of parts and the letters that they have of their own. Kicks of parts add up to the kick of the
// whole, merge, are counted part by part, and make r-RESPA. Kepler's motion is exact, and Wisdom's and
// Holman's method errs by the masses of the planets times h^2. In a uniform magnetic field the helix is exact
// and symplectic, and Boris' method keeps volume and no more.
#include "../../examples/systems/bonded_chain.hpp"
#include "../../examples/systems/charged_particle.hpp"
#include "../../examples/systems/planets.hpp"
#include "../support/dense.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/families/multiple_time_steps.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace examples;
using namespace nysalt::test;

namespace {

static_assert(Family<planetary<2>>);

using dynamic_state = phase_point<double, Eigen::Dynamic>;

void must_be_what_they_state(const model& system, std::string_view letters,
                             const std::vector<dynamic_state>& points, double h) {
  for (const char letter : letters) {
    const letter_check found = check_letter(system, letter, points, h);
    BOOST_TEST(found.passed(), found.report());
  }
}

/// The largest change of a function of the state during n steps, sampled every k-th step.
double largest_change(const auto& system, const auto& method, double step, const auto& start,
                      std::int64_t steps, const auto& of, std::int64_t every = 1) {
  double worst = 0.0;
  const auto watch = [&](std::int64_t, double, const auto& x) {
    worst = std::max(worst, std::abs(of(x) - of(start)));
  };
  integrate(system, method, step, start, steps, watch, every);
  return worst;
}

using chain_of_4 = bonded_chain<4>;
const chain_of_4 chain(stiff_bonds<4>(20.0), soft_charges<4>(2.0));
const phase_point<double, 4> start{{0.01, -0.02, 0.0, 0.03}, {0.3, -0.1, 0.2, 0.4}};

constexpr word kicks_of_all = alternating_word<kick_of_parts<0, 1>, drift, 3>();
/// Velocity Verlet, whose kick is that of all parts.
const method verlet_of_parts("verlet_of_parts", kicks_of_all, {0.5, 0.5, 1.0, 0.5, 0.5}, {2, true, false});
/// Each part has a time of its own, other ones at the end.
const method unequal_parts("unequal_parts", kicks_of_all, {0.3, 0.6, 1.0, 0.7, 0.4}, {1, false, false});

phase_point<double, 4> after(const method& method, double step, int steps) {
  return integrate(chain, method, step, start, steps).finish;
}

using point = std::array<double, 3>;

/// Where r'' = -r/|r|^3 leads from the pericentre of an orbit of eccentricity e and pericentre 1 in time t.
std::array<point, 2> moved(double e, double t) {
  point q{1.0, 0.0, 0.0};
  point v{0.0, std::sqrt(1.0 + e), 0.0};
  orbits::move_on_orbit(1.0, t, q, v);
  return {q, v};
}

/// Kepler's equation and Barker's: the time from the pericentre to q on that orbit, from its shape alone.
double time_of(double e, const point& q) {
  const double r = std::hypot(q[0], q[1]);
  if (e < 1.0) {
    const double a = 1.0 / (1.0 - e);
    const double anomaly = std::atan2(q[1] / (a * std::sqrt(1.0 - e * e)), q[0] / a + e);
    return std::pow(a, 1.5) * (anomaly - e * std::sin(anomaly));
  }
  if (e == 1.0) {
    const double w = q[1] / (r + q[0]);  // the tangent of half the true anomaly
    return std::numbers::sqrt2 * (w + w * w * w / 3.0);
  }
  const double a = 1.0 / (e - 1.0);
  const double anomaly = std::asinh(q[1] / (a * std::sqrt(e * e - 1.0)));
  return std::pow(a, 1.5) * (e * std::sinh(anomaly) - anomaly);
}

/// The outer solar system with the masses of the planets times a factor, on the same orbits.
std::pair<solar_system<5>, phase_point<double, 15>> with_masses(double factor) {
  const auto known = outer_solar_system();
  const auto& masses = known.part<0>().masses();
  std::array<double, 6> scaled{};
  for (std::size_t k = 0; k < 6; ++k) scaled[k] = masses.mass(k) * (k == 0 ? 1.0 : factor);
  const solar_system<5> system(scaled, masses.gravity());
  auto from = outer_solar_system_start();
  for (Eigen::Index i = 0; i < 15; ++i) from.p[i] *= known.inverse_mass(i) / system.inverse_mass(i);
  return {system, from};
}

/// Largest relative error of the energy in 30,000 days.
double energy_error(const solar_system<5>& system, const phase_point<double, 15>& from, const method& method,
                    double step) {
  const double before = energy<double>(system, from);
  return largest_change(system, method, step, from, static_cast<std::int64_t>(30'000.0 / step),
                        [&](const auto& x) { return energy<double>(system, x) / before; });
}

const penning_trap trap(penning_potential(1.0, 0.1), 5.0);
const phase_point<double, 3> ion = trap.at({0.3, -0.2, 0.4}, {0.5, 0.1, -0.3});

/// The trap with a force, without which it is no model; its letters do not use the force.
struct trap_with_force : penning_trap {
  explicit trap_with_force(const penning_trap& system) : penning_trap(system) {}
  template <class T>
  void force(const vector<T, 3>& q, vector<T, 3>& f) const {
    part<0>().force(q, f);
  }
};

/// Lorentz' equation by the classical method of Runge and Kutta, which knows of no letters.
phase_point<double, 3> by_runge_kutta(double step, int steps) {
  using state = Eigen::Matrix<double, 6, 1>;
  const auto rate = [](const state& y) {
    vector<double, 3> f;
    trap.part<0>().force(vector<double, 3>(y.head<3>()), f);
    const double omega = trap.cyclotron_frequency();
    state result;
    result << y.tail<3>(), f[0] + omega * y[4], f[1] - omega * y[3], f[2];
    return result;
  };
  state y;
  y << ion.q, trap.velocity_of(ion);
  for (int n = 0; n < steps; ++n) {
    const state a = rate(y);
    const state b = rate(y + 0.5 * step * a);
    const state c = rate(y + 0.5 * step * b);
    const state d = rate(y + step * c);
    y += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return trap.at(y.head<3>(), y.tail<3>());
}

}  // namespace

BOOST_AUTO_TEST_CASE(parts_are_one_system) {
  vector<double, 4> whole;
  vector<double, 4> first;
  vector<double, 4> second;
  force<double>(chain, start.q, whole);
  force<double>(chain.part<0>(), start.q, first);
  force<double>(chain.part<1>(), start.q, second);
  BOOST_TEST((whole - first - second).cwiseAbs().maxCoeff() <= 4.0 * eps * whole.cwiseAbs().maxCoeff());
  BOOST_TEST(second.cwiseAbs().maxCoeff() > 0.1);  // no part is empty
  BOOST_TEST(chain.potential(start.q) ==
             chain.part<0>().potential(start.q) + chain.part<1>().potential(start.q));
  BOOST_TEST(check_force(chain.part<0>(), {start.q, vector<double, 4>(2.0 * start.q)}).passed());
  BOOST_TEST(check_force(chain.part<1>(), {start.q, vector<double, 4>(2.0 * start.q)}).passed());
  BOOST_TEST(describe(chain) == "stiff_bonds(4, omega=20) + soft_charges(4, strength=2)");
  static_assert(HasParts<chain_of_4> && !HasParts<phi4_chain<>> && NystromSystem<chain_of_4>);
  using pair = sum_of_parts<phi4_chain<>, phi4_chain<>>;
  BOOST_CHECK_THROW(pair(phi4_chain<>(3), phi4_chain<>(4)), std::invalid_argument);
}

// Two sums of the same numbers in another order differ by some roundings a step, which 50 steps amplify
// tenfold.
BOOST_AUTO_TEST_CASE(kicks_of_all_parts_are_the_kick_of_the_whole) {
  BOOST_TEST(distance(after(verlet_of_parts, 0.02, 50), after(verlet(), 0.02, 50)) <= 1e4 * eps);
  BOOST_TEST(distance(after(r_respa<0, 1, 1>(), 0.02, 50), after(verlet(), 0.02, 50)) <= 1e4 * eps);
  BOOST_TEST(distance(after(r_respa<0, 1, 2>(), 0.02, 50), after(verlet(), 0.02, 50)) > 1e-5);
}

BOOST_AUTO_TEST_CASE(kicks_of_several_times_have_the_same_bits_by_the_type_of_a_system_and_its_model) {
  const auto of_model = [](const method& method) {
    return integrate(model(chain), method, 0.01, dynamic_state{start.q, start.p}, 20).finish;
  };
  const auto by_type = after(unequal_parts, 0.01, 20);
  BOOST_TEST(same_bits(of_model(unequal_parts), dynamic_state{by_type.q, by_type.p}));
  const nysalt::method swapped("swapped", kicks_of_all, {0.6, 0.3, 1.0, 0.4, 0.7}, {1, false, false});
  BOOST_TEST(!same_bits(of_model(swapped), dynamic_state{by_type.q, by_type.p}));
}

BOOST_AUTO_TEST_CASE(letters_that_a_system_has_not_are_refused) {
  const phi4_chain<4> whole;
  BOOST_TEST(refuses([&] { make_stepper(whole, verlet_of_parts, 0.1); },
                     {"kAk", "the system must declare the letter k"}));
  const with_letters<phi4_chain<4>, kick_of_parts<0, 1>> in_name_only;
  BOOST_TEST(refuses([&] { make_stepper(in_name_only, verlet_of_parts, 0.1); },
                     {"kAk", "the letter k must serve the system"}));
  // Of H = (p - A(q))^2/2 + V(q) there is no drift.
  for (const method& method : {nysalt::method(verlet()), nysalt::method(verlet_aba())}) {
    BOOST_TEST(refuses([&] { make_stepper(trap, method, 0.1); },
                       {method.letters().view(), "must be one that the system declares", "K(p) + V(q)"}));
  }
}

BOOST_AUTO_TEST_CASE(evaluations_are_counted_part_by_part) {
  constexpr const word& letters = detail::nested_word<0, 1, 5>;
  static_assert(letters.merges && evaluations_of_part(letters, 0) == 5 &&
                evaluations_of_part(letters, 1) == 1);
  static_assert(evaluations_of_part(letters, 2) == 0);
  static_assert(letters.evaluations_per_step == 6);
  static_assert(declared_cost(letters, std::array{1.0, 100.0}) == 105.0);
  constexpr const word& learned = nested_kicks<0, 1, 3, 2>::letters;
  static_assert(evaluations_of_part(learned, 0) == 6 && evaluations_of_part(learned, 1) == 2);
}

// J^T Omega J - Omega sums 2 N products of entries up to |J|^2, each off by some hundred roundings.
BOOST_AUTO_TEST_CASE(r_respa_is_symplectic_reversible_and_of_order_two) {
  const r_respa<0, 1, 4> method;
  BOOST_TEST(symplecticity_defect(chain, method, 0.05, start) <= 8.0 * 100.0 * eps * 20.0 * 20.0);
  BOOST_TEST(reversibility_defect(chain, method, 0.05, start) <= 1e3 * eps);
  // Halving the step at a fixed time quarters the error: 3 to 5 leaves room for the next power.
  const auto exact = after(srkn11b(), 0.0005, 1000);
  const double coarse = distance(after(method, 0.01, 50), exact);
  const double fine = distance(after(method, 0.005, 100), exact);
  BOOST_TEST(coarse / fine > 3.0);
  BOOST_TEST(coarse / fine < 5.0);
}

// Where the outer step is half a period of a fast mode the slow kicks resonate with it: the energy grows, and
// does not where the step is a little shorter. The highest mode of four free bonds is omega (2 + sqrt
// 2)^(1/2).
BOOST_AUTO_TEST_CASE(the_outer_step_resonates_with_the_fast_modes) {
  const double omega = 20.0 * std::sqrt(2.0 + std::sqrt(2.0));
  const double half_period = std::acos(-1.0) / omega;
  const auto growth = [&](double step) {
    return largest_change(
        chain, r_respa<0, 1, 8>(), step, start, 2'000, [](const auto& x) { return energy<double>(chain, x); },
        10);
  };
  BOOST_TEST(growth(half_period * 0.9) < 0.1);
  double at_resonance = 0.0;
  for (double part = 0.99; part < 0.996; part += 0.001) {  // the charges shift it by less than a hundredth
    at_resonance = std::max(at_resonance, growth(part * half_period));
  }
  BOOST_TEST(at_resonance > 1.0);
}

BOOST_AUTO_TEST_CASE(a_family_over_two_forces_is_learned) {
  const normal_around<4> starts({vector<double, 4>::Zero(), vector<double, 4>::Zero()}, 0.01, 0.3);
  const auto data = [&](std::uint64_t seed) {
    return make_flow_map_data(chain, starts, fine_steps(0.0025),
                              {.step = 0.06, .horizon = 0.6, .trajectories = 16, .seed = seed});
  };
  const auto found =
      learn(nested_kicks<0, 1, 4>(), chain, data(1), data(2), {.random_starts = 2, .planned_steps = 1000});
  BOOST_TEST(found.summary.usable, found.summary.reason);
  BOOST_TEST(found.summary.held_out_loss < 0.25 * found.summary.held_out_start_loss);  // half the error
  using family = nested_kicks<0, 1, 4>;
  const auto first = family::coefficients(family::start());
  BOOST_TEST(std::ranges::equal(first, r_respa<0, 1, 4>().coefficients()));
}

// On ellipses, a parabola and hyperbolas the time is that of the place: the place is off by some tens of
// roundings, by which the time is as far off as the orbit is long.
BOOST_AUTO_TEST_CASE(the_place_has_the_time_of_keplers_equation) {
  for (const double e : {0.0, 0.3, 0.9, 0.99, 1.0, 1.5, 3.0}) {
    for (const double t : {1e-6, 0.1, -0.7, 1.5, 2.9}) {
      const auto [q, v] = moved(e, t);
      BOOST_TEST(std::abs(time_of(e, q) - t) <= 1e3 * eps * (1.0 + std::abs(t)), "e " << e << " t " << t);
      BOOST_TEST(std::abs(q[0] * v[1] - q[1] * v[0] - std::sqrt(1.0 + e)) <= 1e2 * eps);
    }
  }
  const auto [q, v] = moved(0.3, 1.5);
  BOOST_TEST(std::abs(time_of(0.3, q) - 1.501) > 5e-4);
}

BOOST_AUTO_TEST_CASE(many_revolutions_lead_where_part_of_one_does) {
  const double e = 0.5;
  const double period = 2.0 * std::numbers::pi * std::pow(1.0 - e, -1.5);
  const auto [near, v_near] = moved(e, 0.4);
  const auto [far, v_far] = moved(e, 0.4 + 10.0 * period);
  for (std::size_t c = 0; c < 3; ++c) {
    BOOST_TEST(std::abs(far[c] - near[c]) <=
               1e4 * eps);  // ten periods of 18 round by 2e3 eps, speeds are 1.2
    BOOST_TEST(std::abs(v_far[c] - v_near[c]) <= 1e4 * eps);
  }
}

BOOST_AUTO_TEST_CASE(forces_are_gradients_and_those_of_the_solar_system_add_up) {
  const auto system = outer_solar_system();
  const auto q = outer_solar_system_start().q;
  BOOST_TEST(check_force(system.part<0>(), {q, vector<double, 15>(1.1 * q)}).passed());
  BOOST_TEST(check_force(system.part<1>(), {q, vector<double, 15>(1.1 * q)}).passed());
  // Two bodies have no interaction beside Kepler's motion: it is rounding of its two terms, and not with
  // three.
  const solar_system<1> two({1.0, 0.1}, 1.0);
  const vector<double, 3> r{0.6, -0.2, 0.5};
  vector<double, 3> f;
  two.part<1>().force(r, f);
  BOOST_TEST(f.cwiseAbs().maxCoeff() <= 10.0 * eps);
  vector<double, 15> kepler;
  vector<double, 15> rest;
  system.part<0>().force(q, kepler);
  system.part<1>().force(q, rest);
  const double ratio = rest.cwiseAbs().maxCoeff() / kepler.cwiseAbs().maxCoeff();
  BOOST_TEST(ratio > 1e-6);  // of the planets' masses, Jupiter's being 1e-3
  BOOST_TEST(ratio < 1e-3);
  BOOST_CHECK_THROW(solar_system<1>({1.0, 0.0}, 1.0), std::invalid_argument);
  BOOST_CHECK_THROW(solar_system<1>({-1.0, 0.1}, 1.0), std::invalid_argument);
  BOOST_CHECK_THROW(solar_system<1>({1.0, 0.1}, 0.0), std::invalid_argument);
  BOOST_TEST(check_force(trap.part<0>(), {ion.q, vector<double, 3>(2.0 * ion.q)}).passed());
  BOOST_CHECK_THROW(penning_trap(penning_potential(1.0), 0.0), std::invalid_argument);
  BOOST_CHECK_THROW(penning_potential(0.0), std::invalid_argument);
}

// The known error, epsilon h^2 with epsilon the masses of the planets over that of the sun
// [wisdom_holman_1991]: halving the step leaves a quarter, a tenth of the masses a tenth, each to a fifth, as
// the next terms are h^2 and epsilon smaller. That of Verlet does not know of masses.
BOOST_AUTO_TEST_CASE(the_error_of_wisdom_holman_is_the_mass_of_the_planets_times_h_squared) {
  const auto [system, from] = with_masses(1.0);
  const double error = energy_error(system, from, wisdom_holman(), 200.0);
  BOOST_TEST(std::abs(error / energy_error(system, from, wisdom_holman(), 100.0) / 4.0 - 1.0) < 0.2);
  const auto [light, light_start] = with_masses(0.1);
  BOOST_TEST(std::abs(error / energy_error(light, light_start, wisdom_holman(), 200.0) / 10.0 - 1.0) < 0.2);
  const double of_verlet = energy_error(system, from, verlet(), 200.0);
  BOOST_TEST(std::abs(of_verlet / energy_error(light, light_start, verlet(), 200.0) - 1.0) < 0.2);
  BOOST_TEST(error < 0.01 * of_verlet);
}

BOOST_AUTO_TEST_CASE(letters_are_what_they_state) {
  const std::vector of_chain{dynamic_state{start.q, start.p}, {-2.0 * start.q, 0.5 * start.p}};
  must_be_what_they_state(chain, "01k", of_chain, 0.1);
  BOOST_TEST(check_letter(chain, 'k', of_chain, 0.1, {0.3, 0.7}).passed());

  const auto system = outer_solar_system();
  const auto from = outer_solar_system_start();
  auto later = from;
  stepper(system, word_of<kepler_flow>(), {1.0}, 4000.0).step(later);
  const std::vector of_planets{dynamic_state{from.q, from.p}, {later.q, later.p}};
  for (const double time : {1.0, 400.0, 20'000.0}) must_be_what_they_state(system, "K", of_planets, time);
  must_be_what_they_state(system, "1", of_planets, 400.0);

  const auto other = trap.at({-0.1, 0.5, 0.2}, {0.2, -0.6, 0.1});
  const std::vector of_trap{dynamic_state{ion.q, ion.p}, {other.q, other.p}};
  for (const double time : {0.05, 3.0}) {
    must_be_what_they_state(trap_with_force(trap), "m0vw", of_trap, time);
  }
}

// J^T Omega J - Omega sums 6 products of entries of order ten, each off by some hundred roundings. Boris'
// method keeps volume: det J = 1 to as many roundings.
BOOST_AUTO_TEST_CASE(cyclotron_verlet_is_symplectic_and_boris_keeps_volume) {
  constexpr double rounding = 6.0 * 100.0 * 100.0 * eps;
  BOOST_TEST(symplecticity_defect(trap, cyclotron_verlet(), 0.2, ion) <= rounding);
  BOOST_TEST(symplecticity_defect(trap, boris(), 0.2, ion) > 1e-3);
  const double volume = determinant(detail::jacobian(detail::step_map(trap, boris(), 0.2), ion));
  BOOST_TEST(std::abs(volume - 1.0) <= rounding);
}

// Halving the step leaves a quarter of the error, to a tenth by the terms of h^4.
BOOST_AUTO_TEST_CASE(magnetic_methods_are_of_order_two) {
  const auto exact = by_runge_kutta(0.0005, 4000);
  const auto off = [&](const auto& method, double step, int steps) {
    return distance(integrate(trap, method, step, ion, steps).finish, exact);
  };
  const auto ratio = [&](const auto& method) { return off(method, 0.01, 200) / off(method, 0.005, 400); };
  BOOST_TEST(std::abs(ratio(boris()) / 4.0 - 1.0) < 0.1);
  BOOST_TEST(std::abs(ratio(cyclotron_verlet()) / 4.0 - 1.0) < 0.1);
  BOOST_TEST(off(cyclotron_verlet(), 0.005, 400) < 0.5 * off(boris(), 0.005, 400));
}
