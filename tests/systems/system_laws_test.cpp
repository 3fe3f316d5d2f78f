// SPDX-License-Identifier: BSL-1.0
// What holds for every system: the force is minus the gradient of the potential, modes diagonalise the
// quadratic part, frequencies lie in the bands, references conserve the energy; and mistakes are found.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "../laws/laws.hpp"
#include "../support/systems.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/pendulum.hpp"
#include "nysalt/systems/phi4_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(force_is_minus_the_gradient_of_the_potential) {
  draws random;
  int tried = 0;
  for (const auto& one : specimens_with([](const model& s) { return s.facts().has_potential_over_slopes; })) {
    ++tried;
    for (int n = 0; n < 20; ++n) {
      BOOST_TEST_CONTEXT(describe(one.system) << ", draw " << n) {
        BOOST_TEST(gradient_defect(one.system, one.at_random(random).q) <= 1.0);
      }
    }
  }
  BOOST_TEST(tried >= 20);
}

BOOST_AUTO_TEST_CASE(a_force_too_strong_by_one_percent_is_found) {
  draws random;
  const model system{wrong_force()};
  BOOST_TEST(gradient_defect(system, random.state(system, 1.0).q) > 1e6);
}

// The derivative of a black box is compared with that of the pendulum, which it hides.
BOOST_AUTO_TEST_CASE(a_black_box_has_derivatives_too) {
  draws random;
  const auto visible = [](double x) { return std::cos(x); };
  for (int n = 0; n < 20; ++n) {
    const double x = random.uniform(-3.0, 3.0);
    const vector<double, 1> q(x);
    BOOST_TEST_CONTEXT("q = " << x) {
      BOOST_TEST(std::abs(test::hessian(black_box_with_derivative(), q)(0, 0) - visible(x)) <= 2.0 * eps);
      // Central differences along a displacement of 1: |f'''| s^2 / 6 + |f| eps / s.
      const double s = detail::part_of_displacement;
      const double error = std::abs(test::hessian(black_box(), q)(0, 0) - visible(x));
      BOOST_TEST(error <= s * s / 6.0 + 4.0 * eps * std::max(1.0, std::abs(x)) / s);
    }
  }
  BOOST_TEST(derivative_source<pendulum>() == "automatic differentiation");
  BOOST_TEST(derivative_source<black_box>() == "central differences of the force");
  BOOST_TEST(derivative_source<black_box_with_derivative>() == "the system's directional derivative");
}

BOOST_AUTO_TEST_CASE(velocity_is_the_gradient_of_the_kinetic_energy) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const vector<double, 1> p(random.uniform(-3.0, 3.0));
    vector<double, 1> by_autodiff;
    vector<double, 1> own;
    velocity<double>(relativistic(), p, by_autodiff);
    velocity<double>(relativistic_with_velocity(), p, own);
    BOOST_TEST(std::abs(by_autodiff[0] - own[0]) <= 4.0 * eps);  // |v| < 1, four operations
  }
  const auto x = random.state(two_masses(), 1.0);
  vector<double, 2> v;
  velocity<double>(two_masses(), x.p, v);
  BOOST_TEST(v[0] == x.p[0]);
  BOOST_TEST(v[1] == 0.25 * x.p[1]);
}

BOOST_AUTO_TEST_CASE(references_conserve_energy) {
  draws random;
  const tabulated srkn{srkn11b()};
  for (const auto& one : specimens_with([](const model& s) { return has_energy(s); })) {
    const auto x = one.at_random(random);
    BOOST_TEST_CONTEXT(describe(one.system)) {
      // 13 evaluations make a step of an error within the tolerance; a rejected one only adds to the count.
      const double tolerance = 1e-12;
      const double error = tolerance * size_of(x) / 13.0 + 8.0 * eps * size_of(x);
      const auto [end, evaluations] = by_odeint(one.system, x, 2.0, tolerance);
      BOOST_TEST(evaluations > 0);
      BOOST_TEST(energy_defect(one.system, x, end, evaluations, error) <= 1.0);
      if (!has_quadratic_kinetic(one.system)) continue;
      // SRKN11b at w h = 5e-3 errs by (w h)^7 < 1e-16 a step; each evaluation rounds q and p.
      const double steps = std::ceil(400.0 * shears_at(one.system, x).frequency());
      const double rounding = 2.0 * eps * size_of(x);
      const auto fine = run_of{one.system, srkn, 2.0 / steps}.finish(x, static_cast<std::int64_t>(steps));
      BOOST_TEST(energy_defect(one.system, x, fine, static_cast<std::int64_t>(11.0 * steps) + 1, rounding) <=
                 1.0);
      const auto coarse =
          run_of{one.system, tabulated(verlet()), 100.0 / steps}.finish(x, 4);  // an honest failure
      BOOST_TEST(energy_defect(one.system, x, coarse, 5, rounding) > 1e3);
    }
  }
}

BOOST_AUTO_TEST_CASE(modes_diagonalise_the_quadratic_part_and_leave_the_soft_force) {
  draws random;
  int tried = 0;
  for (const auto& one : specimens_with([](const model& s) { return has_modes(s); })) {
    const model& system = one.system;
    BOOST_TEST_CONTEXT(describe(system)) {
      if (describe(system).find("with a quadratic part") == std::string::npos) {  // else not V''(0)
        BOOST_TEST(modes_defect(system, system.modes()) <= 1.0);
        auto wrong = system.modes();
        wrong.frequencies.tail(1) *= 1.0 + 1e-6;
        BOOST_TEST(modes_defect(system, wrong) > 10.0);
        wrong = system.modes();
        wrong.basis(0, 0) *= 1.0 + 1e-6;
        BOOST_TEST(modes_defect(system, wrong) > 10.0);
      }
      if (!has_quadratic_part(system)) continue;
      ++tried;
      for (int n = 0; n < 20; ++n) {
        const auto q = one.at_random(random).q;
        BOOST_TEST(soft_force_defect(system, q) <= 1.0);
        Eigen::VectorXd soft = q;
        system.soft_force(q, soft);
        if (soft.norm() > 0.0) BOOST_TEST(soft_force_defect(system, q, 1.0 + 1e-6) > 10.0);
      }
    }
  }
  BOOST_TEST(tried >= 8);  // with masses, too
}

// Bands.

BOOST_AUTO_TEST_CASE(linear_systems_have_their_frequencies_in_the_bands) {
  draws random;
  for (const auto& one : specimens_with([](const model& s) {
         const std::string name = describe(s);
         return name.starts_with("harmonic") || name.starts_with("linear_chain");
       })) {
    const auto q = one.at_random(random).q;
    BOOST_TEST(band_defect(one.system, one.system.frequency_bands(), q) <= 1.0);
    const double highest = one.system.frequency_bands().back().high;
    BOOST_TEST(band_defect(one.system, {{0.0, highest * (1.0 - 1e-6)}}, q) > 10.0);
  }
}

// Stated for soft bonds that hold up to 2 each, however far the stiff ones are stretched.
BOOST_AUTO_TEST_CASE(the_bands_of_the_fpu_chain_hold_while_soft_bonds_are_not_overloaded) {
  const fpu_chain<3> chain(10.0);
  const model system(chain);
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
    outside = std::max(outside, band_defect(system, chain.frequency_bands(), q));
    outside_half = std::max(outside_half, band_defect(system, chain.frequency_bands(0.5), q));
  }
  BOOST_TEST(outside <= 1.0);
  BOOST_TEST(outside_half > 10.0);  // bands for a quarter of the energy do not hold
}

BOOST_AUTO_TEST_CASE(the_bands_of_phi4_hold_while_wells_are_not_overloaded) {
  const phi4_chain<> chain(8);
  const model system(chain);
  const double farthest = std::pow(8.0, 0.25);  // q^4/4 = 2
  draws random;
  for (int n = 0; n < 50; ++n) {
    BOOST_TEST(band_defect(system, chain.frequency_bands(), random.state(system, farthest).q) <= 1.0);
  }
  Eigen::VectorXd zigzag(8);
  for (int i = 0; i < 8; ++i) zigzag[i] = i % 2 == 0 ? farthest : -farthest;
  BOOST_TEST(band_defect(system, chain.frequency_bands(), zigzag) <= 1.0);
  BOOST_TEST(band_defect(system, chain.frequency_bands(1.99), zigzag) > 10.0);
}

BOOST_AUTO_TEST_CASE(the_bands_of_the_pendulum_hold_while_it_hangs) {
  const model system{pendulum()};
  draws random;
  for (int n = 0; n < 50; ++n) {
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, random.uniform(-1.0, 1.0) * std::numbers::pi);
    BOOST_TEST(band_defect(system, system.frequency_bands(), q) <= 1.0);
  }
  BOOST_TEST(band_defect(system, {{0.0, 0.5}}, Eigen::VectorXd::Constant(1, 0.1)) > 10.0);
}

BOOST_AUTO_TEST_CASE(the_bands_of_henon_and_heiles_hold_on_bounded_orbits) {
  const model system{henon_heiles()};
  draws random;
  for (int n = 0; n < 50; ++n) {
    const double r = random.uniform(0.0, 1.0);
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Eigen::Vector2d q(r * std::cos(angle), r * std::sin(angle));
    BOOST_TEST(band_defect(system, system.frequency_bands(), q) <= 1.0);
  }
  BOOST_TEST(band_defect(system, system.frequency_bands(), Eigen::Vector2d(1.1, 0.0)) > 10.0);
}

// Of many coordinates no full matrix of modes is made, and what is known of them is the same.

BOOST_AUTO_TEST_CASE(entries_of_a_long_chain_are_those_of_the_basis_of_a_short_one) {
  const fpu_chain<> shorter(most_for_full_basis / 2, 50.0);
  const fpu_chain<> longer(most_for_full_basis / 2 + 1, 50.0);
  BOOST_TEST(shorter.modes().entries.empty());
  BOOST_TEST(shorter.modes().basis.rows() == most_for_full_basis);
  BOOST_TEST(longer.modes().basis.size() == 0);
  const auto few = modal_coordinates::of(shorter);
  const auto many = modal_coordinates::of(longer);
  BOOST_TEST(many->entries().size() == few->entries().size() + 4);
  BOOST_TEST(many->frequencies().size() == few->frequencies().size() + 2);
  const Eigen::Index pairs = shorter.pairs();
  for (std::size_t n = 0; n < few->entries().size(); ++n) {
    const auto& a = few->entries()[n];
    const auto& b = many->entries()[n];
    // Stiff modes come after all soft ones, of which the longer chain has one more.
    const Eigen::Index mode = a.mode < pairs ? a.mode : a.mode + 1;
    const bool is_same = a.coordinate == b.coordinate && mode == b.mode && a.heavy == b.heavy;
    if (!is_same) BOOST_ERROR("entry " << n << " differs");
  }
  BOOST_TEST(detail::frequency_to_fit(longer) == 50.0);
}

BOOST_AUTO_TEST_CASE(they_lead_there_and_back) {
  const fpu_chain<> chain(800, 50.0);
  const auto modes = modal_coordinates::of(chain);
  Eigen::VectorXd q(chain.size());
  Eigen::VectorXd p(chain.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = std::sin(0.1 * static_cast<double>(i));
    p[i] = std::cos(0.3 * static_cast<double>(i));
  }
  Eigen::VectorXd x = q, y = q, q_back = q, p_back = q;
  modes->to_modes(q, p, x, y);
  modes->from_modes(x, y, q_back, p_back);
  // Each is two products of a sum of two products.
  BOOST_TEST((q_back - q).cwiseAbs().maxCoeff() <= 8.0 * eps);
  BOOST_TEST((p_back - p).cwiseAbs().maxCoeff() <= 8.0 * eps);
  // The first spring's: x_1 = (q_2 - q_1)/sqrt(2).
  BOOST_TEST(std::abs(x[800] - (q[1] - q[0]) * std::sqrt(0.5)) <= 4.0 * eps);
  normal_modes wrong = chain.modes();
  wrong.entries[3].mode = chain.size();
  struct told : fpu_chain<> {
    explicit told(normal_modes given) : fpu_chain<>(800, 50.0), all(std::move(given)) {}
    normal_modes modes() const { return all; }
    normal_modes all;
  };
  BOOST_CHECK_THROW(modal_coordinates::of(told(wrong)), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_long_ring_has_no_modes_and_a_model_says_so) {
  BOOST_TEST(has_modes(phi4_chain<>(most_for_full_basis)));
  BOOST_TEST(!has_modes(phi4_chain<>(most_for_full_basis + 1)));
  BOOST_TEST(has_modes(model(phi4_chain<>(16))));
  BOOST_TEST(!has_modes(model(phi4_chain<>(most_for_full_basis + 1))));
  BOOST_TEST(has_modes(model(fpu_chain<>(most_for_full_basis, 50.0))));
}
