// SPDX-License-Identifier: BSL-1.0
// Where eigenvalues of opposite Krein signature meet a step is not strongly stable; where those of like
// signature meet it is.
#include "nysalt/derivatives/strong_stability.hpp"

#include <boost/test/unit_test.hpp>

#include <Eigen/SVD>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Two oscillators that a step turns by these angles, in coordinates (q_1, q_2, p_1, p_2).
Eigen::Matrix4d turned_by(double first, double second) {
  const Eigen::Vector2d cosines(std::cos(first), std::cos(second));
  const Eigen::Vector2d sines(std::sin(first), std::sin(second));
  Eigen::Matrix4d m;
  m << Eigen::Matrix2d(cosines.asDiagonal()), Eigen::Matrix2d(sines.asDiagonal()),
      Eigen::Matrix2d((-sines).asDiagonal()), Eigen::Matrix2d(cosines.asDiagonal());
  return m;
}

/// A kick that couples the two: p -= by K q with a symmetric K of chance.
Eigen::Matrix4d kick_of_chance(std::uint64_t seed, double by) {
  std::mt19937_64 bits(seed);
  std::normal_distribution<double> normal;
  Eigen::Matrix2d k;
  k(0, 0) = normal(bits);
  k(1, 1) = normal(bits);
  k(0, 1) = k(1, 0) = 1.0 + std::abs(normal(bits));  // coupled
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.bottomLeftCorner<2, 2>() = -by * k;
  return m;
}

double norm_of(const Eigen::Matrix4d& m) { return Eigen::JacobiSVD<Eigen::MatrixXd>(m).singularValues()(0); }

}  // namespace

BOOST_AUTO_TEST_CASE(opposite_signatures_meet_where_the_sum_of_two_angles_is_a_whole_turn) {
  const auto met = spectrum_of(turned_by(1.0, 2.0 * std::numbers::pi - 1.0));
  BOOST_TEST(met.growth <= 16.0 * eps);
  BOOST_TEST(met.krein_distance <= 16.0 * eps);
  // The first turns by 1.0, the second by 1.0 short of a whole turn and 0.01 more.
  const auto near = spectrum_of(turned_by(1.0, 2.0 * std::numbers::pi - 0.99));
  BOOST_TEST(std::abs(near.krein_distance - 0.01) <= 64.0 * eps);
  // The difference of angles is a whole turn: of like signature. Of opposite signature are +-1, 2 apart.
  const auto like = spectrum_of(turned_by(1.0, 1.0));
  BOOST_TEST(like.growth <= 16.0 * eps);
  BOOST_TEST(std::abs(like.krein_distance - 2.0) <= 64.0 * eps);
}

// The theorem of Krein, Gelfand and Lidskii: perturbations of any small size.
BOOST_AUTO_TEST_CASE(a_small_kick_makes_only_a_meeting_of_opposite_signatures_unstable) {
  int grown = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto kick = kick_of_chance(seed, 1e-3);
    // Diagonal entries shift the angles, and the pair is moved to where they meet again.
    const double shift = -0.5 * (kick(2, 0) + kick(3, 1));
    const auto opposite = spectrum_of(kick * turned_by(1.0, 2.0 * std::numbers::pi - 1.0 - shift));
    grown += opposite.growth > 1e-4 ? 1 : 0;  // a coupling of 1e-3 or more grows by some half of it
    const auto like = spectrum_of(kick * turned_by(1.0, 1.0));
    BOOST_TEST(like.growth <= 1e-12);  // rounding, by the condition of nearly equal eigenvalues
    BOOST_TEST(like.krein_distance > 1.9);
  }
  BOOST_TEST(grown == 20);
}

BOOST_AUTO_TEST_CASE(a_step_off_the_circle_has_its_growth_and_no_distance) {
  Eigen::Matrix2d stretched;
  stretched << 2.0, 0.0, 0.0, 0.5;
  const auto spectrum = spectrum_of(stretched);
  BOOST_TEST(std::abs(spectrum.growth - std::log(2.0)) <= 4.0 * eps);
  BOOST_TEST(spectrum.krein_distance == 0.0);
  BOOST_TEST(!spectrum.is_on_circle());
  const auto turned = spectrum_of(-stretched);  // the phase is that of the multiplier
  BOOST_TEST(std::abs(std::abs(turned.first) - std::numbers::pi) <= 4.0 * eps);
  BOOST_TEST(turned.second == turned.first);
  BOOST_TEST(spectrum_of(turned_by(1.0, 2.0)).is_on_circle());
  Eigen::Matrix2d shear;  // both eigenvalues 1, with one vector
  shear << 1.0, 1.0, 0.0, 1.0;
  BOOST_TEST(spectrum_of(shear).krein_distance <= 1e-6);
  BOOST_TEST(!(spectrum_of(turned_by(1.0, 2.0)).krein_distance <= 1e-6));
  BOOST_TEST(refuses<std::invalid_argument>([] { spectrum_of(Eigen::MatrixXd::Identity(3, 3)); },
                                            {"even number of rows", "got 3 rows"}));
}

// A step so small that no mode turns leaves a matrix without rows.
BOOST_AUTO_TEST_CASE(a_step_without_modes_has_no_eigenvalues) {
  const auto spectrum = spectrum_of(Eigen::MatrixXd(0, 0));
  BOOST_TEST(spectrum.growth == 0.0);
  BOOST_TEST(spectrum.krein_distance == std::numbers::pi);
  BOOST_TEST(spectrum_of(turned_by(1.0, 2.0)).krein_distance < std::numbers::pi);
}

BOOST_AUTO_TEST_CASE(powers_of_two_show_the_largest_power) {
  constexpr std::int64_t steps = 4096;
  int large = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double apart = 0.05 * static_cast<double>(seed) / 20.0;
    const Eigen::Matrix4d m =
        kick_of_chance(seed, 0.005) * turned_by(1.0, 2.0 * std::numbers::pi - 1.0 + apart);
    double largest = 1.0;
    Eigen::Matrix4d power = m;
    for (std::int64_t n = 1; n <= steps; ++n) {
      largest = std::max(largest, norm_of(power));
      power = (power * m).eval();
    }
    const double found = largest_power(m, steps);
    if (largest >= 1e6) {
      BOOST_TEST(std::isinf(found));
      continue;
    }
    BOOST_TEST(found <= largest * (1.0 + 1e-9));
    BOOST_TEST(found >= largest * 0.5 * std::numbers::sqrt3 * 0.95);  // single phases beside the difference
    large += largest > 2.0 ? 1 : 0;
  }
  BOOST_TEST(large >= 2);
  // Fewer steps than the difference of phases needs do not show it.
  const Eigen::Matrix4d slow =
      kick_of_chance(1, 1e-3) * turned_by(1.0, 2.0 * std::numbers::pi - 1.0 + 0.0002);
  BOOST_TEST(largest_power(slow, 4) < 1.05);
}
