// SPDX-License-Identifier: BSL-1.0
// The modes of a stiffness matrix diagonalise it, zero frequencies are zero, and what is no such matrix is
// refused.
#include "nysalt/detail/stiffness_modes.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "support/draws.hpp"
#include "support/refusal.hpp"
#include "support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;

/// Three masses on two springs, held by nothing.
Eigen::MatrixXd of_free_chain() {
  Eigen::MatrixXd stiffness(3, 3);
  stiffness << 2.0, -2.0, 0.0, -2.0, 5.0, -3.0, 0.0, -3.0, 3.0;
  return stiffness;
}

}  // namespace

BOOST_AUTO_TEST_CASE(they_diagonalise_the_weighted_stiffness) {
  draws random;
  for (const Eigen::Index n : {1, 2, 5, 12}) {
    Eigen::MatrixXd half(n, n);
    for (double& x : half.reshaped()) x = random.uniform(-1.0, 1.0);
    Eigen::MatrixXd stiffness = half * half.transpose();
    stiffness = 0.5 * (stiffness + Eigen::MatrixXd(stiffness.transpose()));
    Eigen::VectorXd inverse_masses(n);
    for (double& x : inverse_masses) x = random.uniform(0.2, 5.0);
    const normal_modes modes = stiffness_modes(stiffness, inverse_masses, "test");
    const Eigen::MatrixXd& basis = modes.basis;
    const Eigen::VectorXd& frequencies = modes.frequencies;
    const Eigen::VectorXd root = inverse_masses.cwiseSqrt();
    const Eigen::MatrixXd weighted = root.asDiagonal() * stiffness * root.asDiagonal();
    // An eigensolver errs by some n eps |K|, the product of three matrices adds 3 n eps |K|.
    const double rounding = 8.0 * static_cast<double>(n * n) * eps;
    const Eigen::MatrixXd squares = frequencies.cwiseAbs2().asDiagonal();
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << n << " masses") {
      BOOST_TEST(norm(basis.transpose() * basis - Eigen::MatrixXd::Identity(n, n)) <= rounding);
      BOOST_TEST(norm(basis.transpose() * weighted * basis - squares) <= rounding * norm(weighted));
      BOOST_TEST(norm(basis.transpose() * stiffness * basis - squares) > 1e-3);  // masses matter
      BOOST_TEST(frequencies.minCoeff() >= 0.0);
    }
  }
}

// Where squares of entries overflow or underflow too. A power of four scales without rounding.
BOOST_AUTO_TEST_CASE(frequencies_scale_with_the_root_of_the_stiffness) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(3);
  const auto known = stiffness_modes(of_free_chain(), ones, "test").frequencies;
  for (const int power : {-260, -1, 1, 260}) {
    const auto scaled =
        stiffness_modes(std::ldexp(1.0, 2 * power) * of_free_chain(), ones, "test").frequencies;
    BOOST_TEST((scaled == std::ldexp(1.0, power) * known), "4^" << power << ": " << scaled.transpose());
  }
}

BOOST_AUTO_TEST_CASE(a_frequency_of_zero_is_zero_and_no_rounding) {
  const auto free = stiffness_modes(of_free_chain(), Eigen::Vector3d(1.0, 0.5, 0.2), "test");
  BOOST_TEST(free.frequencies[0] == 0.0);
  BOOST_TEST(free.frequencies[1] > 0.1);
  const auto nothing = stiffness_modes(Eigen::MatrixXd::Zero(2, 2), Eigen::Vector2d(1.0, 1.0), "test");
  BOOST_TEST(nothing.frequencies.norm() == 0.0);
  const auto soft = stiffness_modes(Eigen::Vector2d(1.0, 1e-12).asDiagonal(), Eigen::Vector2d(1.0, 1.0), "");
  BOOST_TEST(soft.frequencies[0] == 1e-6, boost::test_tools::tolerance(1e-3));  // eps/1e-12
}

BOOST_AUTO_TEST_CASE(what_is_no_stiffness_matrix_is_refused) {
  const auto refused = [](const Eigen::MatrixXd& stiffness, Eigen::Index masses,
                          std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { stiffness_modes(stiffness, Eigen::VectorXd::Ones(masses), "who asks"); },
                          words);
  };
  Eigen::MatrixXd skew(2, 2);
  skew << 1.0, 0.5, 0.25, 1.0;
  Eigen::MatrixXd hot = Eigen::MatrixXd::Identity(2, 2);
  hot(1, 1) = std::nan("");
  BOOST_TEST(refused(Eigen::MatrixXd(0, 0), 0, {"who asks", "square", "0 x 0"}));
  BOOST_TEST(refused(Eigen::MatrixXd::Zero(2, 3), 2, {"square", "2 x 3"}));
  BOOST_TEST(refused(Eigen::MatrixXd::Identity(2, 2), 3, {"who asks"}));
  BOOST_TEST(refused(hot, 2, {"who asks", "must be finite"}));
  BOOST_TEST(refused(skew, 2, {"who asks", "symmetric"}));
  BOOST_TEST(refused(Eigen::Vector2d(1.0, -1e-3).asDiagonal(), 2, {"who asks", "must be >= 0", "-0.001"}));
  BOOST_TEST(!refused(of_free_chain(), 3, {}));
}
