// SPDX-License-Identifier: BSL-1.0
// Phase-fitted methods turn the oscillator exactly, and are the classical ones for small steps.
#include "nysalt/methods/phase_fitted.hpp"

#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "../laws/laws.hpp"
#include "../laws/models.hpp"
#include "../support/dense.hpp"
#include "../support/refusal.hpp"
#include "../support/step_matrix.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using bagab = phase_fitted<fg_chin, chin4a>;
using abagaba = phase_fitted<fg4, omelyan_fg4>;

/// Up to 5 all are defined; pi and 2, where sin z and nearly cos z vanish, are no exceptions.
constexpr std::array some_z{1e-7, 1e-3, 0.1, 0.5, 1.0, 1.57, 2.0, 3.0, std::numbers::pi, 3.2, 4.0, 5.0};

struct comparison {
  double difference;
  double rounding;
};

/// The step's matrix in (q, z p) against the rotation by z. Each of its letters adds two roundings of a
/// product that is at most the product of the letters' norms; solving for the coefficients can leave as much
/// again, and is doubled for the rounding of theta itself.
comparison against_rotation(const tabulated& method, double z) {
  const run_time_word& word = method.letters();
  const auto c = method.coefficients();
  const auto m = matrix_on_oscillator(word, c, z * z);
  double size = 1.0;
  for (std::size_t i = 0; i < word.length; ++i) {
    const double first = std::abs(c[word.first_slot(i)]);
    const double bent = word.slots_of(i) == 2 ? 2.0 * std::abs(c[word.first_slot(i) + 1]) * z * z * z : 0.0;
    size *= 1.0 + first * z + bent;
  }
  const double cosine = std::cos(z);
  const double sine = std::sin(z);
  return {std::max({std::abs(m.qq - cosine), std::abs(m.pp - cosine), std::abs(m.qp * z - sine),
                    std::abs(m.pq / z + sine)}),
          6.0 * static_cast<double>(word.slots) * eps * size};
}

/// A fitted method at any z, the classical one that it began with, and how far their parameters are apart.
struct fitted {
  std::function<tabulated(double)> at;
  tabulated classical;
  std::function<double(double)> moved;
};
template <Family F, Method M>
fitted fitted_of(phase_fitted<F, M>*) {
  return {[](double z) { return tabulated(phase_fitted<F, M>(z)); }, tabulated(M()),
          [](double z) {
            const auto theta = phase_fitted<F, M>(z).parameters();
            const auto from = F::of(M());
            double most = 0.0;
            for (std::size_t k = 0; k < theta.size(); ++k)
              most = std::max(most, std::abs(theta[k] - from[k]));
            return most;
          }};
}
std::vector<fitted> all_fitted() {
  std::vector<fitted> all;
  for_each<fitted_methods>([&]<class M>() { all.push_back(fitted_of(static_cast<M*>(nullptr))); });
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_step_is_the_rotation) {
  for (const auto& each : all_fitted()) {
    for (const double z : some_z) {
      const auto [difference, rounding] = against_rotation(each.at(z), z);
      BOOST_TEST(difference <= rounding, each.at(z).name()
                                             << " at " << z << ": " << difference << " > " << rounding);
    }
    // The classical method is not, nor is one that is fitted to a frequency a thousandth higher.
    const auto classical = against_rotation(each.classical, 2.0);
    BOOST_TEST(classical.difference > 100.0 * classical.rounding);
    const auto nearby = against_rotation(each.at(2.002), 2.0);
    BOOST_TEST(nearby.difference > 100.0 * nearby.rounding);
  }
}

// The methods' own errors on the oscillator are of order z^2 relative to their coefficients, which have to
// make up for them; and for the smallest z, rounding of theta remains.
BOOST_AUTO_TEST_CASE(for_small_steps_it_is_the_classical_method) {
  for (const auto& each : all_fitted()) {
    for (const double z : {1e-9, 1e-4, 1e-2, 0.1}) BOOST_TEST(each.moved(z) <= 0.1 * z * z + 16.0 * eps);
    BOOST_TEST(each.moved(1.0) > 1e-6);
  }
}

// Of the members that turn the oscillator so, the nearest: what it moved lies in the span of the gradients of
// the equations, to the square root of rounding's effect on a minimum's place, in double.
BOOST_AUTO_TEST_CASE(it_is_the_nearest_member) {
  const double z = 2.5;
  const auto check = [&](const auto& family, const auto& theta, const auto& from, bool nearest) {
    const auto n = static_cast<Eigen::Index>(theta.size());
    const Eigen::VectorXd here = Eigen::Map<const Eigen::VectorXd>(theta.data(), n);
    const Eigen::VectorXd moved = here - Eigen::Map<const Eigen::VectorXd>(from.data(), n);
    const run_time_family data(family);
    const Eigen::MatrixXd normals = detail::jacobian_of_defect(data, here, z * z).transpose();
    const double beside = (normals * least_squares(normals, moved, 1e-9) - moved).norm();
    BOOST_TEST((beside <= 1e-8 * moved.norm()) == nearest);
  };
  check(fg4{}, abagaba(z).parameters(), fg4::of(omelyan_fg4()), true);
  check(bab<6>{}, phase_fitted<bab<6>, srkn6b>(z).parameters(), bab<6>::of(srkn6b()), true);
  check(fg4{}, abagaba(z).parameters(), fg4::start(), false);  // it is not the nearest to Chin's
}

// sin z/z and cot(z/2) cancel to 8/z^4 of their rounding in c. The equations hold z^2 b and round with it;
// from 5 on to 2 pi, where b has a pole, with more.
BOOST_AUTO_TEST_CASE(of_bagab_there_is_a_closed_form) {
  for (const double z : {0.5, 1.0, 2.0, 3.0, std::numbers::pi, 4.0, 5.0}) {
    const double b = 2.0 / (z * z) - 1.0 / (std::tan(0.5 * z) * z);
    const double c = ((1.0 - 2.0 * b) * z * z - 4.0 * (1.0 - std::sin(z) / z)) / (2.0 * std::pow(z, 4));
    const auto theta = bagab(z).parameters();
    const double of_b = 8.0 * eps * (2.0 / (z * z) + (1.0 + z * z) * (1.0 + std::abs(b)));
    BOOST_TEST(std::abs(theta[0] - b) <= of_b);
    BOOST_TEST(std::abs(theta[1] - c) <= 8.0 * eps * (1.0 + 8.0 / std::pow(z, 4)) + of_b);
    BOOST_TEST(std::abs(bagab(z + 1e-6).parameters()[0] - b) > of_b);
  }
}

// Fitted anew at each step, omega fixed; allowed as in order_test.cpp. With the coefficients of one step it
// is 2.
BOOST_AUTO_TEST_CASE(the_order_is_that_of_the_classical_method) {
  constexpr double allowed = 0.15;
  constexpr double omega = 1.3;
  draws random;
  const auto problem_of = [&](const char* name) {
    auto one = specimen_of(name);
    one.reach.reach *= 2.0;
    return solved(one.system, {one.at_random(random), one.at_random(random), one.at_random(random)}, 4.0);
  };
  const auto of_pendulum = problem_of("pendulum()");
  const auto of_galaxy = problem_of("henon_heiles");
  for (const auto& each : all_fitted()) {
    const auto at = [&](double h) { return table(each.at(omega * std::min(h, 1.0))); };
    BOOST_TEST(std::abs(measured_order(of_pendulum, at, 8) - each.classical.order) <= allowed);
    BOOST_TEST(std::abs(measured_order(of_galaxy, at, 8) - each.classical.order) <= allowed);
    BOOST_TEST(each.at(1.0).order == each.classical.order);
    BOOST_TEST(std::abs(measured_order(of_galaxy, table(each.at(2.0)), 64) - 2.0) <= allowed);
  }
}

// The frequency of the modes, as bands have room for what soft forces add; of who has no modes, the highest.
BOOST_AUTO_TEST_CASE(a_system_and_a_step_give_the_z) {
  const auto z_for = [](const auto& system, double step) {
    return phase_fitted_for<fg_chin, chin4a>(system, step).z();
  };
  BOOST_TEST(z_for(harmonic_oscillator(50.0), 0.04) == 50.0 * 0.04);
  BOOST_TEST(z_for(harmonic_oscillator(50.0), -0.04) == 50.0 * 0.04);
  BOOST_TEST(z_for(fpu_chain<3>(50.0), 0.02) == 50.0 * 0.02);
  BOOST_TEST((fpu_chain<3>(50.0).frequency_bands().back().high > 50.0));
  BOOST_TEST(z_for(henon_heiles(), 0.5) == 0.5);
  BOOST_TEST(z_for(pendulum(), 0.5) == 0.5);  // one band, 0 to 1
  BOOST_TEST(bagab::name() == "phase_fitted_chin4a");
}

BOOST_AUTO_TEST_CASE(impossible_z_are_refused_with_a_sentence) {
  using wrong = std::invalid_argument;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  for (const double z : {0.0, -1.0, infinite, not_a_number}) {
    BOOST_TEST(refuses<wrong>([&] { bagab{z}; }, {"phase_fitted_chin4a", "positive and finite"}));
  }
  // b = 2/z^2 - cot(z/2)/z grows without bound towards 2 pi.
  BOOST_TEST(refuses<wrong>([&] { bagab{2.0 * std::numbers::pi}; },
                            {"phase_fitted_chin4a", "at most 6.2", "6.283", "take a smaller step"}));
  BOOST_TEST(
      refuses<wrong>([&] { phase_fitted<aba<4>, pefrl>{5.5}; }, {"phase_fitted_pefrl", "at most 5.38"}));
  BOOST_CHECK_NO_THROW((phase_fitted<aba<4>, pefrl>{5.38}));
  BOOST_TEST(refuses<wrong>([&] { phase_fitted_for<fg_chin, chin4a>(harmonic_oscillator(50.0), 0.0); },
                            {"positive and finite"}));
}
