// SPDX-License-Identifier: BSL-1.0
// A few residuals instead of very many: to Ceres the same function.
#include "nysalt/learning/compressed_cost.hpp"

#include <boost/test/unit_test.hpp>

#include <array>
#include <limits>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Residuals r + J (theta - 0) of a linear problem.
squares of(const Eigen::MatrixXd& j, const Eigen::VectorXd& r) {
  return {r.squaredNorm(), j.transpose() * r, j.transpose() * j};
}

struct small_block {
  bool accepted;
  Eigen::VectorXd r;
  Eigen::MatrixXd j;
};
small_block compress(const squares& all, bool with_jacobian = true) {
  using rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index count = all.half_gradient.size();
  const compressed_cost cost([&](const Eigen::VectorXd&) { return all; },
                             [](const Eigen::VectorXd&) { return true; }, static_cast<int>(count));
  const Eigen::VectorXd theta = Eigen::VectorXd::Zero(count);
  const double* at = theta.data();
  Eigen::VectorXd r(count + 1);
  rows j = rows::Zero(count + 1, count);
  double* slopes = j.data();
  const bool accepted = cost.Evaluate(&at, r.data(), with_jacobian ? &slopes : nullptr);
  return {accepted, r, j};
}

Eigen::MatrixXd random_matrix(draws& random, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd result(rows, columns);
  for (auto& x : result.reshaped()) x = random.uniform(-1.0, 1.0);
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_small_block_has_loss_gradient_and_normal_matrix_of_the_large_one) {
  draws random;
  for (Eigen::Index count = 1; count <= 4; ++count) {
    const Eigen::MatrixXd j = random_matrix(random, 50, count);
    const Eigen::VectorXd r = random_matrix(random, 50, 1);
    const auto all = of(j, r);
    const auto block = compress(all);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << count << " parameters") {
      BOOST_TEST(block.accepted);
      BOOST_TEST(block.r.size() == count + 1);
      // 50 terms, and a dozen operations on each eigenvector.
      const double rounding = 100.0 * eps;
      BOOST_TEST(std::abs(block.r.squaredNorm() - all.value) <= rounding * all.value);
      BOOST_TEST(norm(block.j.transpose() * block.r - all.half_gradient) <= rounding * norm(j.transpose()));
      BOOST_TEST(norm(block.j.transpose() * block.j - all.normal_matrix) <=
                 rounding * norm(all.normal_matrix));
      const auto value_only = compress(all, false);
      BOOST_TEST(std::abs(value_only.r.squaredNorm() - all.value) <= rounding * all.value);
    }
  }
}

BOOST_AUTO_TEST_CASE(directions_in_which_nothing_changes_are_left_out) {
  draws random;
  Eigen::MatrixXd j = random_matrix(random, 50, 3);
  j.col(2) = 2.0 * j.col(0);  // along (2, 0, -1) nothing changes
  const Eigen::VectorXd r = random_matrix(random, 50, 1);
  const auto all = of(j, r);
  const auto block = compress(all);
  BOOST_TEST(block.j.allFinite());
  BOOST_TEST((block.j * Eigen::Vector3d(2.0, 0.0, -1.0)).norm() <= 100.0 * eps * norm(j));
  BOOST_TEST((block.j.rowwise().squaredNorm().array() == 0.0).count() == 2);  // that, and the rest of r
  BOOST_TEST(std::abs(block.r.squaredNorm() - all.value) <= 100.0 * eps * all.value);
  j(0, 2) += 1e-4;  // a shallow direction is none: 1e-8 of the largest eigenvalue
  BOOST_TEST((compress(of(j, r)).j.rowwise().squaredNorm().array() == 0.0).count() == 1);
}

BOOST_AUTO_TEST_CASE(where_the_jacobian_explains_all_the_rest_is_zero_and_no_nan) {
  draws random;
  const Eigen::MatrixXd j = random_matrix(random, 50, 2);
  for (int n = 0; n < 100; ++n) {
    const auto all = of(j, j * random_matrix(random, 2, 1));
    const auto block = compress(all);
    BOOST_TEST(block.r.allFinite());
    BOOST_TEST(block.r[2] * block.r[2] <= 100.0 * eps * all.value);
  }
  const auto nothing = compress({0.0, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()});
  BOOST_TEST(nothing.accepted);
  BOOST_TEST(nothing.r.norm() == 0.0);
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_or_not_defined_is_rejected) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(!compress({nan, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()}).accepted);
  BOOST_TEST(!compress({1.0, Eigen::Vector2d(nan, 0.0), Eigen::Matrix2d::Zero()}).accepted);
  BOOST_TEST(!compress({1.0, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Constant(nan)}).accepted);
  int calls = 0;
  const auto counting = [&](const Eigen::VectorXd&) {
    ++calls;
    return squares{1.0, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity()};
  };
  const compressed_cost cost(
      counting, [](const Eigen::VectorXd& theta) { return theta[0] > 0.0; }, 2);
  std::array<double, 2> theta{-1.0, 0.0};
  std::array<double, 3> r{};
  const double* at = theta.data();
  BOOST_TEST(!cost.Evaluate(&at, r.data(), nullptr));
  BOOST_TEST(calls == 0);
  theta[0] = 1.0;
  std::array<double, 6> j{};
  double* slopes = j.data();
  BOOST_TEST(cost.Evaluate(&at, r.data(), nullptr));
  BOOST_TEST(cost.Evaluate(&at, r.data(), &slopes));  // the same place costs no second pass
  BOOST_TEST(calls == 1);
}
