// SPDX-License-Identifier: BSL-1.0
// Modes diagonalise the quadratic part, and frequencies lie in the bands.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <numbers>

#include "../laws/models.hpp"
#include "../laws/system_laws.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(modes_diagonalise_the_quadratic_part, Model, systems) {
  const auto system = Model::make();
  if constexpr (HasModes<system_of<Model>>) {
    BOOST_TEST(modes_defect(system, system.modes()) <= 1.0);
    auto wrong = system.modes();
    wrong.frequencies.tail(1) *= 1.0 + 1e-6;
    BOOST_TEST(modes_defect(system, wrong) > 10.0);
    wrong = system.modes();
    wrong.basis(0, 0) *= 1.0 + 1e-6;
    BOOST_TEST(modes_defect(system, wrong) > 10.0);
  }
}

// That of the quadratic part is -M^{1/2} U diag(w^2) U^T M^{1/2} q. Each of some 8 n operations rounds a term
// up to |V''| |q| + |f|.
template <SeparableSystem S>
double soft_force_defect(const S& system, const vector<double, S::dimension>& q, double factor) {
  auto whole = make_vector<double>(system);
  auto soft = whole;
  force<double>(system, q, whole);
  system.soft_force(q, soft);
  const auto modes = system.modes();
  const Eigen::VectorXd squares = modes.frequencies.cwiseAbs2();
  const Eigen::VectorXd linear = -(modes.basis * squares.asDiagonal() * modes.basis.transpose() * q);
  const double term = norm(hessian(system, q)) * q.cwiseAbs().maxCoeff() + whole.cwiseAbs().maxCoeff();
  return (whole - linear - soft * factor).cwiseAbs().maxCoeff() /
         (8.0 * static_cast<double>(q.size()) * eps * term);
}

BOOST_AUTO_TEST_CASE_TEMPLATE(the_soft_force_is_what_modes_leave, Model, systems) {
  using S = system_of<Model>;
  const auto system = Model::make();
  if constexpr (HasSoftForce<S> && !HasInverseMass<S>) {
    static_assert(HasModes<S>);
    draws random;
    for (int n = 0; n < 20; ++n) {
      const auto q = random.state(system, Model::reach).q;
      BOOST_TEST(soft_force_defect(system, q, 1.0) <= 1.0);
      BOOST_TEST(soft_force_defect(system, q, 1.0 + 1e-6) > 10.0);
    }
  }
}

using linear_systems = std::tuple<an_oscillator, a_chain, a_free_chain>;

BOOST_AUTO_TEST_CASE_TEMPLATE(linear_systems_have_their_frequencies_in_the_bands, Model, linear_systems) {
  const auto system = Model::make();
  draws random;
  const auto q = random.state(system, 1.0).q;
  BOOST_TEST(band_defect(system, system.frequency_bands(), q) <= 1.0);
  const double highest = system.frequency_bands().back().high;
  BOOST_TEST(band_defect(system, {{0.0, highest * (1.0 - 1e-6)}}, q) > 10.0);
}

// Stated for soft bonds that hold up to 2 each, however far the stiff ones are stretched.
BOOST_AUTO_TEST_CASE(the_bands_of_the_fpu_chain_hold_while_soft_bonds_are_not_overloaded) {
  const fpu_chain<3> system(10.0);
  const double longest = std::pow(2.0, 0.25);
  draws random;
  int tried = 0;
  double outside = 0.0;
  double outside_half = 0.0;
  while (tried < 200) {
    const auto q = random.state(system, 3.0 * longest).q;
    const std::array bonds{q[0], q[2] - q[1], q[4] - q[3], q[5]};
    if (std::any_of(bonds.begin(), bonds.end(), [&](double u) { return std::abs(u) > longest; })) continue;
    ++tried;
    outside = std::max(outside, band_defect(system, system.frequency_bands(), q));
    outside_half = std::max(outside_half, band_defect(system, system.frequency_bands(0.5), q));
  }
  BOOST_TEST(outside <= 1.0);
  BOOST_TEST(outside_half > 10.0);  // bands for a quarter of the energy do not hold
}

BOOST_AUTO_TEST_CASE(the_bands_of_phi4_hold_while_wells_are_not_overloaded) {
  const phi4_chain<8> system;
  const double farthest = std::pow(8.0, 0.25);  // q^4/4 = 2
  draws random;
  for (int n = 0; n < 50; ++n) {
    const auto q = random.state(system, farthest).q;
    BOOST_TEST(band_defect(system, system.frequency_bands(), q) <= 1.0);
  }
  vector<double, 8> zigzag;
  for (int i = 0; i < 8; ++i) zigzag[i] = i % 2 == 0 ? farthest : -farthest;
  BOOST_TEST(band_defect(system, system.frequency_bands(), zigzag) <= 1.0);
  BOOST_TEST(band_defect(system, system.frequency_bands(1.99), zigzag) > 10.0);
}

BOOST_AUTO_TEST_CASE(the_bands_of_the_pendulum_hold_while_it_hangs) {
  const pendulum system;
  draws random;
  for (int n = 0; n < 50; ++n) {
    const vector<double, 1> q(random.uniform(-std::numbers::pi, std::numbers::pi));
    BOOST_TEST(band_defect(system, system.frequency_bands(), q) <= 1.0);
  }
  BOOST_TEST(band_defect(system, {{0.0, 0.5}}, vector<double, 1>(0.1)) > 10.0);
}

BOOST_AUTO_TEST_CASE(the_bands_of_henon_and_heiles_hold_on_bounded_orbits) {
  const henon_heiles system;
  draws random;
  for (int n = 0; n < 50; ++n) {
    const double r = random.uniform(0.0, 1.0);
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const vector<double, 2> q(r * std::cos(angle), r * std::sin(angle));
    BOOST_TEST(band_defect(system, system.frequency_bands(), q) <= 1.0);
  }
  BOOST_TEST(band_defect(system, system.frequency_bands(), vector<double, 2>(1.1, 0.0)) > 10.0);
}
