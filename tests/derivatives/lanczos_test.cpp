// SPDX-License-Identifier: BSL-1.0
// Both ends of a symmetric spectrum are bounded, and nearly met.
#include <boost/test/unit_test.hpp>

#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/lanczos.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

Eigen::VectorXd random_vector(draws& random, Eigen::Index n) {
  Eigen::VectorXd v(n);
  for (double& x : v) x = random.uniform(-1.0, 1.0);
  return v;
}

/// With these eigenvalues, in a basis of chance.
Eigen::MatrixXd symmetric(draws& random, const Eigen::VectorXd& eigenvalues) {
  const Eigen::Index n = eigenvalues.size();
  Eigen::MatrixXd a(n, n);
  for (Eigen::Index k = 0; k < n; ++k) a.col(k) = random_vector(random, n);
  const Eigen::MatrixXd basis = orthogonal_basis(a);
  return basis * eigenvalues.asDiagonal() * basis.transpose();
}

spectrum_ends ends_of(const Eigen::MatrixXd& a, const Eigen::VectorXd& start) {
  return ends_of_spectrum([&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return a * v; }, start);
}

/// Products and projections round each entry of A by some n eps of its size.
double rounding_of(const Eigen::VectorXd& eigenvalues) {
  return 10.0 * static_cast<double>(eigenvalues.size()) * eps * eigenvalues.cwiseAbs().maxCoeff();
}

}  // namespace

BOOST_AUTO_TEST_CASE(small_spectra_are_found_to_rounding) {
  draws random;
  for (Eigen::Index n = 1; n <= 8; ++n) {
    const Eigen::VectorXd values = 100.0 * random_vector(random, n);
    const auto ends = ends_of(symmetric(random, values), random_vector(random, n));
    BOOST_TEST(std::abs(ends.highest - values.maxCoeff()) <= rounding_of(values));
    BOOST_TEST(std::abs(ends.lowest - values.minCoeff()) <= rounding_of(values));
  }
}

// The residual, by which each end is moved outwards, is 1 % at the end; the Ritz value is inside the
// spectrum.
BOOST_AUTO_TEST_CASE(large_spectra_are_bounded_within_two_percent) {
  draws random;
  for (const double lowest : {-1.0, 0.0, -20.0}) {
    Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(200, lowest, 1.0);
    const auto ends = ends_of(symmetric(random, values), random_vector(random, 200));
    BOOST_TEST_CONTEXT("lowest " << lowest) {
      BOOST_TEST(ends.highest >= 0.99);
      BOOST_TEST(ends.highest <= 1.01);
      BOOST_TEST(ends.lowest <= lowest + 0.01 * std::max(1.0, -lowest));
      BOOST_TEST(ends.lowest >= lowest - 0.01 * std::max(1.0, -lowest));
      BOOST_TEST(ends.products < 100);
    }
  }
}

// Power iteration goes to the end that is larger in size: here the wrong one.
BOOST_AUTO_TEST_CASE(larger_negative_eigenvalues_do_not_hide_the_highest) {
  draws random;
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(30, -50.0, -1.0);
  values[29] = 3.0;
  const Eigen::MatrixXd a = symmetric(random, values);
  Eigen::VectorXd v = random_vector(random, 30);
  const auto ends = ends_of(a, v);
  BOOST_TEST(ends.highest >= 3.0 - rounding_of(values));
  BOOST_TEST(ends.highest <= 3.03);
  for (int i = 0; i < 1000; ++i) v = (a * v).normalized();
  BOOST_TEST(std::abs(v.dot(a * v) + 50.0) < 1.0);
}

BOOST_AUTO_TEST_CASE(eigenvalues_that_are_all_one_are_found_at_once) {
  const auto multiple = ends_of(4.0 * Eigen::MatrixXd::Identity(20, 20), Eigen::VectorXd::Ones(20));
  BOOST_TEST(multiple.products <= 2);
  BOOST_TEST(std::abs(multiple.highest - 4.0) < 1e-11);  // closed where the rest is 1e-12 of the size
  BOOST_TEST(std::abs(multiple.lowest - 4.0) < 1e-11);
  const auto nothing = ends_of(Eigen::MatrixXd::Zero(20, 20), Eigen::VectorXd::Ones(20));
  BOOST_TEST(nothing.highest == 0.0);
  BOOST_TEST(nothing.lowest == 0.0);
}

BOOST_AUTO_TEST_CASE(a_start_that_lacks_a_direction_does_not_find_it) {
  const Eigen::MatrixXd a = Eigen::Vector3d(1.0, 2.0, 9.0).asDiagonal();
  BOOST_TEST(ends_of(a, Eigen::Vector3d(1.0, 1.0, 0.0)).highest < 2.1);
  BOOST_TEST(ends_of(a, Eigen::Vector3d(1.0, 1.0, 1e-3)).highest >= 9.0 - 1e-9);
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_is_not_a_number) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(3, 3);
  a(1, 1) = std::numeric_limits<double>::infinity();
  BOOST_TEST(std::isnan(ends_of(a, Eigen::Vector3d::Ones()).highest));
}
