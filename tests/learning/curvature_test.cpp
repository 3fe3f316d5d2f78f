// SPDX-License-Identifier: BSL-1.0
// What follows from a Hessian: flat directions, conditions and standard errors. A few residuals instead of
// very many are to Ceres the same function.
#include "nysalt/learning/curvature.hpp"

#include <Eigen/LU>

#include "../support/draws.hpp"
#include "../support/losses.hpp"
#include "../support/rounding.hpp"
#include "nysalt/learning/compressed_cost.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Curvatures 1 and `small`, the latter along (2, 1)/sqrt 5.
Eigen::MatrixXd valley(double small) {
  const Eigen::Vector2d along = Eigen::Vector2d(2.0, 1.0) / std::sqrt(5.0);
  const Eigen::Vector2d across(-along[1], along[0]);
  return across * across.transpose() + small * along * along.transpose();
}

/// Without others.
Eigen::VectorXd standard_errors_of(const curvature& bend, const std::vector<Eigen::VectorXd>& scores) {
  return bend.spread(scores, std::vector<Eigen::VectorXd>{}).standard_errors;
}

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Residuals r + J (theta - 0) of a linear problem.
squares of(const Eigen::MatrixXd& j, const Eigen::VectorXd& r) {
  return {r.squaredNorm(), j.transpose() * r, j.transpose() * j};
}

/// Of (sin a + b - 1, a b - .3, e^b - 2), with parameters in other units, x = scale theta.
squares in_units(const Eigen::Vector2d& scale, const Eigen::VectorXd& theta) {
  const double a = scale[0] * theta[0];
  const double b = scale[1] * theta[1];
  const Eigen::Matrix<double, 3, 2> j{{std::cos(a), 1.0}, {b, a}, {0.0, std::exp(b)}};
  return of(j * scale.asDiagonal(), Eigen::Vector3d(std::sin(a) + b - 1.0, a * b - 0.3, std::exp(b) - 2.0));
}
Eigen::Matrix2d exact_in_units(const Eigen::Vector2d& x) {
  const double mixed = x[0] * x[1] - 0.3;
  const Eigen::Matrix2d of_second{{-std::sin(x[0]) * (std::sin(x[0]) + x[1] - 1.0), mixed},
                                  {mixed, std::exp(x[1]) * (std::exp(x[1]) - 2.0)}};
  return 2.0 * (in_units(Eigen::Vector2d::Ones(), x).normal_matrix + of_second);
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

BOOST_AUTO_TEST_CASE(parameters_in_any_units_have_the_same_hessian) {
  const Eigen::Vector2d x(0.7, 0.4);
  const Eigen::Matrix2d exact = exact_in_units(x);
  for (const auto& [first, second] : std::vector<std::array<double, 2>>{
           {1.0, 1.0}, {1e4, 1.0}, {1.0, 1e-4}, {1e4, 1e-4}, {1e10, 1e-10}, {1e-6, 1e6}}) {
    const Eigen::Vector2d scale(first, second);
    const objective loss = [&](const Eigen::VectorXd& theta) { return in_units(scale, theta); };
    const Eigen::Vector2d theta = x.cwiseQuotient(scale);
    const Eigen::Matrix2d back = scale.cwiseInverse().asDiagonal();
    const Eigen::Matrix2d found = back * hessian(loss, theta) * back;
    BOOST_TEST_CONTEXT("scales " << first << ", " << second) {
      // Steps are 1e-5 to 1e-3 of what changes the loss: s^2, and rounding, 20 eps/1e-5.
      BOOST_TEST(norm(found - exact) <= 2e-6 * norm(exact));
      if (first != 1e4 && first != 1e10) continue;
      constexpr double s = 1e-5;  // the same for all, as it must not be
      const Eigen::Vector2d ahead(theta[0] + s, theta[1]);
      const Eigen::Vector2d behind(theta[0] - s, theta[1]);
      const double absolute = (loss(ahead).gradient()[0] - loss(behind).gradient()[0]) / (2.0 * s);
      BOOST_TEST(std::abs(absolute / (scale[0] * scale[0]) - exact(0, 0)) > 1e-4 * norm(exact));
    }
  }
}

BOOST_AUTO_TEST_CASE(flat_directions_are_found_and_left_alone) {
  const curvature flat(valley(1e-9), {0, 1});
  BOOST_REQUIRE(flat.flat_directions().size() == 1);
  const Eigen::Vector2d along = flat.flat_directions()[0];
  BOOST_TEST(std::abs(along[0]) == 2.0 / std::sqrt(5.0),
             boost::test_tools::tolerance(1e-8));  // eps/1e-9 at most
  BOOST_TEST(along[0] * along[1] > 0.0);
  BOOST_TEST(flat.condition() == 1.0, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(flat.is_minimum());
  BOOST_TEST(norm(flat.solve(along)) <= 1e-7);  // nothing along the valley
  const Eigen::Vector2d across(-1.0, 2.0);
  BOOST_TEST(norm(flat.solve(across) - across) <= 1e-7);
}

BOOST_AUTO_TEST_CASE(a_shallow_valley_is_not_a_flat_one) {
  const curvature shallow(valley(1e-6), {0, 1});
  BOOST_TEST(shallow.flat_directions().empty());
  BOOST_TEST(shallow.condition() == 1e6,
             boost::test_tools::tolerance(1e-8));  // eps of the larger in the smaller
  const Eigen::Vector2d along(2.0, 1.0);
  BOOST_TEST(norm(shallow.solve(along) - 1e6 * along) <= 1e-8 * 1e6);
  BOOST_TEST(!curvature(valley(-1e-3), {0, 1}).is_minimum());  // a saddle
  BOOST_TEST(curvature(valley(-1e-12), {0, 1}).is_minimum());  // zero, to the Hessian's error
}

BOOST_AUTO_TEST_CASE(only_free_parameters_count) {
  const curvature one(valley(1e-9), {1});
  BOOST_TEST(one.flat_directions().empty());
  BOOST_TEST(one.condition() == 1.0);
  const Eigen::VectorXd solved = one.solve(Eigen::Vector2d(7.0, 1.0));
  BOOST_TEST(solved[0] == 0.0);
  BOOST_TEST(solved[1] == 1.0 / valley(1e-9)(1, 1), boost::test_tools::tolerance(1e-14));
  const curvature none(valley(1.0), {});
  BOOST_TEST(none.is_minimum());
  BOOST_TEST(norm(standard_errors_of(none, std::vector<Eigen::VectorXd>(3, Eigen::Vector2d::Ones()))) == 0.0);
}

BOOST_AUTO_TEST_CASE(standard_errors_are_the_sandwich) {
  const std::vector<Eigen::VectorXd> scores{Eigen::Vector2d(1.0, 0.5), Eigen::Vector2d(-2.0, 0.5),
                                            Eigen::Vector2d(1.0, -1.0)};
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto& score : scores) spread += score * score.transpose();
  const Eigen::Matrix2d bread = valley(0.1).inverse();
  const Eigen::Matrix2d sandwich = bread * spread * bread * 3.0 / 2.0;
  const auto errors = standard_errors_of(curvature(valley(0.1), {0, 1}), scores);
  // A condition of 10, squared, times some 10 roundings.
  BOOST_TEST(norm(errors.cwiseAbs2() - sandwich.diagonal()) <= 1e3 * eps * norm(sandwich));
  const double excess = curvature(valley(0.1), {0, 1}).expected_excess(scores);
  BOOST_TEST(std::abs(excess - 0.5 * (valley(0.1) * sandwich).trace()) <= 1e3 * eps * norm(sandwich));
  BOOST_TEST(std::abs(excess - 0.5 * sandwich.trace()) > 0.01 * excess);  // H matters
  const auto unknown = standard_errors_of(curvature(valley(0.1), {0, 1}), std::vector{scores[0]});
  BOOST_TEST(std::isnan(unknown[0]));
  const auto unbounded = standard_errors_of(curvature(valley(0.0), {0, 1}), scores);
  BOOST_TEST(unbounded[0] == infinite);
  BOOST_TEST(unbounded[1] == infinite);
}

BOOST_AUTO_TEST_CASE(others_count_about_their_mean_as_one_among_the_blocks) {
  const curvature bend(Eigen::MatrixXd::Identity(1, 1), {0});
  const auto score = [](double x) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, x); };
  const std::vector<Eigen::VectorXd> few{score(0.1), score(-0.1)};
  // Four, each of weight 1/4 in their own loss: among two, 1/2. With that they are 2.4 and .4 twice each.
  const std::vector<Eigen::VectorXd> others{score(1.2), score(1.2), score(0.2), score(0.2)};
  const auto found = bend.spread(few, others);
  const double squares = 2.0 * 0.01 + 4.0 * 1.0;  // about 1.4
  BOOST_TEST(found.standard_errors[0] == std::sqrt(squares * 2.0 / (1.0 + 3.0)),
             boost::test_tools::tolerance(1e-14));
  BOOST_TEST(found.deciding[0] == squares * squares / (2.0 * 1e-4 + 4.0),
             boost::test_tools::tolerance(1e-14));
  const auto alone = bend.spread(few, std::vector<Eigen::VectorXd>{});
  BOOST_TEST(alone.standard_errors[0] == std::sqrt(0.02 * 2.0), boost::test_tools::tolerance(1e-14));
  BOOST_TEST(alone.deciding[0] == 2.0, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(bend.spread(few, std::vector{score(5.0)}).standard_errors[0] == alone.standard_errors[0]);
}

// C is infinite along the valley and H zero: what is across it counts alone.
BOOST_AUTO_TEST_CASE(the_expected_excess_is_finite_on_a_flat_direction) {
  const Eigen::Vector2d along = Eigen::Vector2d(2.0, 1.0) / std::sqrt(5.0);
  const Eigen::Vector2d across(-along[1], along[0]);
  const std::vector<Eigen::VectorXd> scores{0.3 * across + along, -0.1 * across, -0.2 * across - along};
  const double expected = 0.5 * 1.5 * (0.09 + 0.01 + 0.04);  // over the curvature 1, and B/(B - 1) = 3/2
  BOOST_TEST(curvature(valley(0.0), {0, 1}).expected_excess(scores) == expected,
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(std::isnan(curvature(valley(0.0), {0, 1}).expected_excess(std::vector{scores[0]})));
  BOOST_TEST(curvature(valley(0.0), {}).expected_excess(scores) == 0.0);
}

BOOST_AUTO_TEST_CASE(where_one_trajectory_outweighs_the_rest_it_alone_decides) {
  const curvature bend(valley(0.1), {0, 1});
  std::vector<Eigen::VectorXd> scores(20, Eigen::Vector2d(1.0, 0.5));
  BOOST_TEST(bend.deciding_blocks(scores) == 20.0, boost::test_tools::tolerance(1e-12));
  scores[7] *= 100.0;  // 10^4 in its square
  BOOST_TEST(bend.deciding_blocks(scores) == 10019.0 * 10019.0 / 100'000'019.0,
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(a_small_block_has_loss_gradient_and_normal_matrix_of_the_large_one) {
  draws random;
  for (Eigen::Index count = 1; count <= 4; ++count) {
    const Eigen::MatrixXd j = random_matrix(random, 50, count);
    const Eigen::VectorXd r = random_matrix(random, 50, 1);
    const auto all = of(j, r);
    const auto block = compress(all);
    BOOST_TEST_CONTEXT(count << " parameters") {
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
