// SPDX-License-Identifier: BSL-1.0
// The Hessian of the loss, and what follows from a Hessian.
#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include <limits>

#include "../laws/models.hpp"
#include "../support/one_step.hpp"
#include "../support/rounding.hpp"
#include "../support/sample_blocks.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/learning/curvature.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Second derivatives without differences: dual numbers of dual numbers.
Eigen::Matrix2d exact_hessian(const auto& pairs, const parameters_of<nystrom>& theta) {
  using inner = dual<double, 2>;
  using outer = dual<inner, 2>;
  std::array<outer, 2> lifted;
  for (int k = 0; k < 2; ++k) {
    const auto i = static_cast<std::size_t>(k);
    lifted[i] = outer::variable(inner::variable(theta[i], k), k);
  }
  outer sum(0.0);
  const double share = 1.0 / static_cast<double>(pairs.windows());
  for (std::size_t pair = 0; pair < pairs.windows(); ++pair) {
    for (const outer& r : pairs.at(pair, lifted)) sum += r * r * share;
  }
  Eigen::Matrix2d result;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j)
      result(i, j) = sum.derivative[static_cast<std::size_t>(i)].derivative[static_cast<std::size_t>(j)];
  }
  return result;
}

/// Curvatures 1 and `small`, the latter along (2, 1)/sqrt 5.
Eigen::MatrixXd valley(double small) {
  const Eigen::Vector2d along = Eigen::Vector2d(2.0, 1.0) / std::sqrt(5.0);
  const Eigen::Vector2d across(-along[1], along[0]);
  return across * across.transpose() + small * along * along.transpose();
}

double sum_of_sizes(const std::vector<Eigen::VectorXd>& vectors) {
  double sum = 0.0;
  for (const auto& v : vectors) sum += v.cwiseAbs().sum();
  return sum;
}

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

BOOST_AUTO_TEST_CASE(the_hessian_is_that_of_nested_dual_numbers) {
  const henon_heiles system;
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.2);
  const auto data = make_flow_map_data(system, starts, fine_steps<>(0.02),
                                       {.step = 0.4, .horizon = 2.0, .trajectories = 7});
  const metric measure(system, data, coordinates::qp);
  const one_step<nystrom> loss(system, data, measure);
  const sample_blocks<nystrom, henon_heiles> pairs(system, data, measure);
  draws random;
  for (int n = 0; n < 5; ++n) {
    const auto theta = random_theta<nystrom>(random);
    const auto exact = exact_hessian(pairs, theta);
    // The differences of step s are off by s^2/6 times the fourth derivatives, whose size we take from the
    // exact Hessian nearby, and by the rounding of gradients over s.
    constexpr double s = 1e-5;
    constexpr double t = 1e-2;
    double fourth = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
      auto ahead = theta;
      auto behind = theta;
      ahead[k] += t;
      behind[k] -= t;
      fourth = std::max(
          fourth, norm(exact_hessian(pairs, ahead) - 2.0 * exact + exact_hessian(pairs, behind)) / (t * t));
    }
    const double rounding = 100.0 * eps * sum_of_sizes(trajectory_gradients(loss, theta)) / s;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", b1 = " << theta[0] << ", beta1 = " << theta[1]) {
      const double error = norm(hessian(loss, theta) - exact);
      BOOST_TEST(error <= 2.0 * s * s / 6.0 * fourth + rounding);
      BOOST_TEST(error <= 1e-5 * norm(exact));  // which says something
      auto beside = theta;
      beside[0] += t;
      BOOST_TEST(norm(hessian(loss, beside) - exact) > 1e-5 * norm(exact));
    }
  }
}

namespace {

/// Residuals of parameters in other units, x = scale theta.
template <class T>
std::array<T, 3> residuals_in_units(const T& a, const T& b) {
  using std::exp;
  using std::sin;
  return {sin(a) + b - 1.0, a * b - 0.3, exp(b) - 2.0};
}

Eigen::Matrix2d exact_in_units(const Eigen::Vector2d& x) {
  using inner = dual<double, 2>;
  using outer = dual<inner, 2>;
  const auto r = residuals_in_units(outer::variable(inner::variable(x[0], 0), 0),
                                    outer::variable(inner::variable(x[1], 1), 1));
  outer sum(0.0);
  for (const outer& one : r) sum += one * one;
  Eigen::Matrix2d result;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = sum.derivative[i].derivative[j];
    }
  }
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(parameters_in_any_units_have_the_same_hessian) {
  const Eigen::Vector2d x(0.7, 0.4);
  const Eigen::Matrix2d exact = exact_in_units(x);
  for (const auto& [first, second] : std::vector<std::array<double, 2>>{
           {1.0, 1.0}, {1e4, 1.0}, {1.0, 1e-4}, {1e4, 1e-4}, {1e10, 1e-10}, {1e-6, 1e6}}) {
    const Eigen::Vector2d scale(first, second);
    const objective loss = [&](const Eigen::VectorXd& theta) -> squares {
      const Eigen::Vector2d at = scale.cwiseProduct(theta);
      const auto r =
          residuals_in_units(dual<double, 2>::variable(at[0], 0), dual<double, 2>::variable(at[1], 1));
      squares result{0.0, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()};
      for (const auto& one : r) {
        const Eigen::Vector2d slope(one.derivative[0] * scale[0], one.derivative[1] * scale[1]);
        result.value += one.value * one.value;
        result.half_gradient += slope * one.value;
        result.normal_matrix += slope * slope.transpose();
      }
      return result;
    };
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
  BOOST_TEST(norm(none.standard_errors(std::vector<Eigen::VectorXd>(3, Eigen::Vector2d::Ones()))) == 0.0);
}

BOOST_AUTO_TEST_CASE(saddles_are_no_minima) {
  BOOST_TEST(!curvature(valley(-1e-3), {0, 1}).is_minimum());
  BOOST_TEST(curvature(valley(-1e-12), {0, 1}).is_minimum());  // zero, to the Hessian's error
}

BOOST_AUTO_TEST_CASE(standard_errors_are_the_sandwich) {
  const std::vector<Eigen::VectorXd> scores{Eigen::Vector2d(1.0, 0.5), Eigen::Vector2d(-2.0, 0.5),
                                            Eigen::Vector2d(1.0, -1.0)};
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto& score : scores) spread += score * score.transpose();
  const Eigen::Matrix2d bread = valley(0.1).inverse();
  const Eigen::Matrix2d sandwich = bread * spread * bread * 3.0 / 2.0;
  const auto errors = curvature(valley(0.1), {0, 1}).standard_errors(scores);
  // A condition of 10, squared, times some 10 roundings.
  BOOST_TEST(norm(errors.cwiseAbs2() - sandwich.diagonal()) <= 1e3 * eps * norm(sandwich));
  const double excess = curvature(valley(0.1), {0, 1}).expected_excess(scores);
  BOOST_TEST(std::abs(excess - 0.5 * (valley(0.1) * sandwich).trace()) <= 1e3 * eps * norm(sandwich));
  BOOST_TEST(std::abs(excess - 0.5 * sandwich.trace()) > 0.01 * excess);  // H matters
  const auto unknown = curvature(valley(0.1), {0, 1}).standard_errors(std::vector{scores[0]});
  BOOST_TEST(std::isnan(unknown[0]));
  const auto unbounded = curvature(valley(0.0), {0, 1}).standard_errors(scores);
  BOOST_TEST(unbounded[0] == infinite);
  BOOST_TEST(unbounded[1] == infinite);
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
  draws random;
  scores.clear();
  for (int n = 0; n < 4000; ++n) {
    scores.emplace_back(Eigen::Vector2d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)));
  }
  // (1/3 + 1/3)^2/(1/5 + 1/5 + 2/9) = 5/7 of them; moments of 4000 numbers are known to one in 60 or better.
  BOOST_TEST(curvature(Eigen::Matrix2d::Identity(), {0, 1}).deciding_blocks(scores) == 4000.0 * 5.0 / 7.0,
             boost::test_tools::tolerance(0.07));
}
