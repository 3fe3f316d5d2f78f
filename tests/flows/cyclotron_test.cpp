// SPDX-License-Identifier: BSL-1.0
// A uniform magnetic field: the helix is exact and symplectic, and Boris' method keeps volume and no more.
#include "nysalt/flows/cyclotron.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/dense.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/derivatives/jacobian.hpp"
#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/magnetic.hpp"
#include "nysalt/systems/charged_particle.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const penning_trap trap(penning_potential(1.0, 0.1), 5.0);
const phase_point<double, 3> start = trap.at({0.3, -0.2, 0.4}, {0.5, 0.1, -0.3});

template <class M>
phase_point<double, 3> after(const M& method, double step, int steps, const penning_trap& in = trap) {
  return integrate(in, method, step, start, steps).finish;
}

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
  y << start.q, trap.velocity_of(start);
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

BOOST_AUTO_TEST_CASE(letters_are_what_they_state) {
  const std::vector points{start, trap.at({-0.1, 0.5, 0.2}, {0.2, -0.6, 0.1})};
  for (const double step : {0.05, 3.0}) {
    BOOST_TEST(check_letter<cyclotron_flow>(trap, points, step).report() == "the letter m is what it states");
    BOOST_TEST(check_letter<kick_of_part<0>>(trap, points, step).report() ==
               "the letter 0 is what it states");
    BOOST_TEST(check_letter<velocity_drift>(trap, points, step).report() == "the letter v is what it states");
    BOOST_TEST(check_letter<boris_turn>(trap, points, step).report() == "the letter w is what it states");
  }
}

namespace {
struct claims_turn : boris_turn {
  static constexpr bool symplectic = true;
};
struct claims_drift : velocity_drift {
  static constexpr bool symplectic = true;
};
struct claims_way_back : cyclotron_flow {
  static constexpr bool reversible = true;
};
}  // namespace

BOOST_AUTO_TEST_CASE(what_boris_letters_are_not_is_found) {
  const auto report = []<class L>(L) { return check_letter<L>(trap, {start}, 0.3).report(); };
  BOOST_TEST(report(claims_turn()).starts_with("the letter w is not symplectic"));
  BOOST_TEST(report(claims_drift()).starts_with("the letter v is not symplectic"));
  BOOST_TEST(report(claims_way_back()).starts_with("the letter m is not reversible"));
}

BOOST_AUTO_TEST_CASE(the_potential_has_this_force) {
  BOOST_TEST(check_force(trap.part<0>(), {start.q, vector<double, 3>(2.0 * start.q)}).passed());
  BOOST_CHECK_THROW(penning_trap(penning_potential(1.0), 0.0), std::invalid_argument);
  BOOST_CHECK_THROW(penning_potential(0.0), std::invalid_argument);
}

// After a turn the particle is where it was, but for its way along the field: some tens of roundings.
BOOST_AUTO_TEST_CASE(without_electric_field_a_turn_closes) {
  const double turn = 2.0 * std::numbers::pi / trap.cyclotron_frequency();
  auto x = start;
  stepper<penning_trap, word<cyclotron_flow>>(trap, {1.0}, turn).step(x);
  const auto v = trap.velocity_of(start);
  BOOST_TEST(std::abs(x.q[0] - start.q[0]) <= 100.0 * eps);
  BOOST_TEST(std::abs(x.q[1] - start.q[1]) <= 100.0 * eps);
  BOOST_TEST(std::abs(x.q[2] - start.q[2] - turn * v[2]) <= 100.0 * eps);
  BOOST_TEST(trap.velocity_of(x).isApprox(v, 100.0 * eps));
  auto half = start;
  stepper<penning_trap, word<cyclotron_flow>>(trap, {0.5}, turn).step(half);
  BOOST_TEST(distance(half, start) > 0.1);
}

// J^T Omega J - Omega sums 6 products of entries of order ten, each off by some hundred roundings. Boris'
// method keeps volume: det J = 1 to as many roundings.
BOOST_AUTO_TEST_CASE(the_one_is_symplectic_and_boris_keeps_volume) {
  constexpr double rounding = 6.0 * 100.0 * 100.0 * eps;
  BOOST_TEST(symplecticity_defect(trap, cyclotron_verlet(), 0.2, start) <= rounding);
  BOOST_TEST(symplecticity_defect(trap, boris(), 0.2, start) > 1e-3);
  const auto volume = [](const auto& method) {
    return eigenvalues(jacobian(step_map(trap, method, 0.2), start)).prod().real();
  };
  BOOST_TEST(std::abs(volume(boris()) - 1.0) <= rounding);
  BOOST_TEST(std::abs(volume(cyclotron_verlet()) - 1.0) <= rounding);
}

BOOST_AUTO_TEST_CASE(a_step_back_undoes_a_step) {
  const auto there_and_back = [](const auto& method) {
    auto x = start;
    make_stepper(trap, method, 0.2).step(x);
    make_stepper(trap, method, -0.2).step(x);
    return distance(x, start);
  };
  BOOST_TEST(there_and_back(boris()) <= 100.0 * eps);
  BOOST_TEST(there_and_back(cyclotron_verlet()) <= 100.0 * eps);
  struct one_sided : cyclotron_verlet {
    static std::array<double, 3> coefficients() { return {0.0, 1.0, 1.0}; }
  };
  BOOST_TEST(there_and_back(one_sided()) > 1e-3);
}

// Halving the step leaves a quarter of the error, to a tenth by the terms of h^4.
BOOST_AUTO_TEST_CASE(both_are_of_order_two) {
  const auto exact = by_runge_kutta(0.0005, 4000);
  const auto ratio = [&](const auto& method) {
    return distance(after(method, 0.01, 200), exact) / distance(after(method, 0.005, 400), exact);
  };
  BOOST_TEST(std::abs(ratio(boris()) / 4.0 - 1.0) < 0.1);
  BOOST_TEST(std::abs(ratio(cyclotron_verlet()) / 4.0 - 1.0) < 0.1);
  BOOST_TEST(distance(after(cyclotron_verlet(), 0.005, 400), exact) <
             0.5 * distance(after(boris(), 0.005, 400), exact));
}

BOOST_AUTO_TEST_CASE(the_energy_stays_for_long) {
  const auto largest = [](const auto& method, double step) {
    const double before = trap.energy_of(start);
    double worst = 0.0;
    const auto watch = [&](std::int64_t, double, const auto& x) {
      worst = std::max(worst, std::abs(trap.energy_of(x) - before));
    };
    integrate(trap, method, step, start, 40'000, watch, 10);
    return worst;
  };
  // In the mean of h^2: a drift over 2,000 times of one would exceed it.
  BOOST_TEST(largest(cyclotron_verlet(), 0.05) < 0.05 * 0.05);
  BOOST_TEST(largest(boris(), 0.05) < 0.05 * 0.05 * 25.0);
}
