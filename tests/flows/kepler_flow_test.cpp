// SPDX-License-Identifier: BSL-1.0
// Kepler's motion is exact, and Wisdom's and Holman's method errs by the masses of the planets times h^2.
#include "nysalt/flows/kepler_flow.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../support/rounding.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/derivatives/reversibility.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/methods/wisdom_holman.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/solar_system.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using point = std::array<double, 3>;

/// Where r'' = -r/|r|^3 leads from the pericentre of an orbit of eccentricity e and pericentre 1 in time t.
std::array<point, 2> moved(double e, double t) {
  point q{1.0, 0.0, 0.0};
  point v{0.0, std::sqrt(1.0 + e), 0.0};
  detail::move_on_orbit(1.0, t, q, v);
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
  auto start = outer_solar_system_start();
  for (Eigen::Index i = 0; i < 15; ++i) start.p[i] *= known.inverse_mass(i) / system.inverse_mass(i);
  return {system, start};
}

/// Largest relative error of the energy in 30,000 days.
template <class M>
double energy_error(const solar_system<5>& system, const phase_point<double, 15>& start, const M& method,
                    double step) {
  const double before = energy<double>(system, start);
  double worst = 0.0;
  const auto watch = [&](std::int64_t, double, const auto& x) {
    worst = std::max(worst, std::abs(energy<double>(system, x) / before - 1.0));
  };
  integrate(system, method, step, start, static_cast<std::int64_t>(30'000.0 / step), watch);
  return worst;
}

}  // namespace

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

BOOST_AUTO_TEST_CASE(the_letter_is_what_it_states) {
  const auto system = outer_solar_system();
  const auto start = outer_solar_system_start();
  auto later = start;
  stepper<solar_system<5>, word<kepler_flow>>(system, {1.0}, 4000.0).step(later);
  for (const double step : {1.0, 400.0, 20'000.0}) {
    BOOST_TEST(check_letter<kepler_flow>(system, {start, later}, step).report() ==
               "the letter K is what it states");
  }
  BOOST_TEST(check_letter<kick_of_part<1>>(system, {start, later}, 400.0).report() ==
             "the letter 1 is what it states");
}

BOOST_AUTO_TEST_CASE(forces_are_gradients_and_add_up) {
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
}

BOOST_AUTO_TEST_CASE(impossible_masses_are_refused) {
  BOOST_CHECK_THROW(solar_system<1>({1.0, 0.0}, 1.0), std::invalid_argument);
  BOOST_CHECK_THROW(solar_system<1>({-1.0, 0.1}, 1.0), std::invalid_argument);
  BOOST_CHECK_THROW(solar_system<1>({1.0, 0.1}, 0.0), std::invalid_argument);
}

// Symplecticity is that of its letters, which check_letter() tries in the units of each coordinate.
BOOST_AUTO_TEST_CASE(wisdom_holman_is_reversible) {
  const auto system = outer_solar_system();
  const auto start = outer_solar_system_start();
  BOOST_TEST(reversibility_defect(system, wisdom_holman(), 400.0, start) <= 1e3 * eps * size_of(start));
  struct one_sided : wisdom_holman {
    static std::array<double, 3> coefficients() { return {0.0, 1.0, 1.0}; }
  };
  BOOST_TEST(reversibility_defect(system, one_sided(), 400.0, start) > 1e-7);
}

// The known error, epsilon h^2 with epsilon the masses of the planets over that of the sun
// [wisdom_holman_1991]: halving the step leaves a quarter, a tenth of the masses a tenth, each to a fifth, as
// the next terms are h^2 and epsilon smaller. That of Verlet does not know of masses.
BOOST_AUTO_TEST_CASE(the_error_is_the_mass_of_the_planets_times_h_squared) {
  const auto [system, start] = with_masses(1.0);
  const double error = energy_error(system, start, wisdom_holman(), 200.0);
  BOOST_TEST(std::abs(error / energy_error(system, start, wisdom_holman(), 100.0) / 4.0 - 1.0) < 0.2);
  const auto [light, light_start] = with_masses(0.1);
  BOOST_TEST(std::abs(error / energy_error(light, light_start, wisdom_holman(), 200.0) / 10.0 - 1.0) < 0.2);
  const double of_verlet = energy_error(system, start, verlet(), 200.0);
  BOOST_TEST(std::abs(of_verlet / energy_error(light, light_start, verlet(), 200.0) - 1.0) < 0.2);
  BOOST_TEST(error < 0.01 * of_verlet);
}

BOOST_AUTO_TEST_CASE(its_kin_are_learned) {
  const auto system = outer_solar_system();
  auto later = outer_solar_system_start();
  std::vector<phase_point<double, 15>> states;
  for (int k = 0; k < 6; ++k) {
    states.push_back(later);
    later = integrate(system, srkn11b(), 100.0, later, 20).finish;
  }
  const auto data = [&](std::size_t from) {
    const listed<15> starts({states.begin() + static_cast<std::ptrdiff_t>(from),
                             states.begin() + static_cast<std::ptrdiff_t>(from) + 3});
    return make_flow_map_data(system, starts, fine_steps<>(20.0),
                              {.step = 400.0, .horizon = 4000.0, .trajectories = 3, .seed = 1});
  };
  const auto found =
      learn(planetary<2>(), system, data(0), data(3), {.random_starts = 2, .planned_steps = 1000});
  BOOST_TEST(found.summary.held_out_loss < 0.5 * found.summary.held_out_start_loss);
}
