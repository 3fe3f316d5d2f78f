// SPDX-License-Identifier: BSL-1.0
// The gradient of the loss is the one that the paper derives by hand, and the slope of the loss; its Hessian
// is that of nested dual numbers.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../support/losses.hpp"
#include "../support/rounding.hpp"
#include "../support/tableau.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/learning/curvature.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using S = henon_heiles;
constexpr double h = 0.4;

flow_map_data some_data() {
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.2);
  return make_flow_map_data(S(), starts, fine_steps<>(0.02), {.step = h, .horizon = 2.0, .trajectories = 7});
}

/// The appendix [li_lu_tao_ye_2023, appendix A]: derivatives of one step by b1 and by beta1, in (q, p), with
/// a Jacobian of the force that is theirs too. x becomes the state after the step.
Eigen::Matrix<double, 4, 2> appendix(const S& system, double b1, double beta1, phase_point<double, 2>& x) {
  const auto t = tableau::symplectic(b1, beta1);
  const vector<double, 2> q = x.q;
  const vector<double, 2> p = x.p;
  const double a21 = (t.beta1 * t.b2 - t.b1 * t.beta2) / t.b2;
  vector<double, 2> l1;
  vector<double, 2> l2;
  force<double>(system, q + h * t.c1 * p, l1);
  const vector<double, 2> second = q + h * t.c2 * p + h * h * a21 * l1;
  force<double>(system, second, l2);
  const Eigen::Matrix2d grad_1 = -test::hessian<S>(system, q + h * t.c1 * p);
  const Eigen::Matrix2d grad_2 = -test::hessian<S>(system, second);
  const vector<double, 2> l1_b = grad_1 * (t.beta1 * h * p / (t.b1 * t.b1));
  const vector<double, 2> l1_beta = -grad_1 * (h * p / t.b1);
  const double beta2_b2 = t.beta2 / (t.b2 * t.b2);
  const vector<double, 2> l2_b = grad_2 * (-h * beta2_b2 * p + h * h * a21 * l1_b - h * h * beta2_b2 * l1);
  const vector<double, 2> l2_beta = grad_2 * (h / t.b2 * p + h * h * a21 * l1_beta + h * h / t.b2 * l1);
  Eigen::Matrix<double, 4, 2> j;
  j.topLeftCorner<2, 1>() = h * h * (t.beta1 * l1_b + t.beta2 * l2_b);
  j.topRightCorner<2, 1>() = h * h * (l1 - l2 + t.beta1 * l1_beta + t.beta2 * l2_beta);
  j.bottomLeftCorner<2, 1>() = h * (l1 - l2 + t.b1 * l1_b + t.b2 * l2_b);
  j.bottomRightCorner<2, 1>() = h * (t.b1 * l1_beta + t.b2 * l2_beta);
  t.step(system, x, h);
  return j;
}

/// The gradient of each trajectory's part of the loss, with the factor 2 that the appendix writes in its
/// second line only, and what rounding may do to it.
struct by_hand {
  Eigen::MatrixXd gradient;
  Eigen::MatrixXd rounding;
};
by_hand gradient_by_hand(const flow_map_data& data, double b1, double beta1) {
  const auto coordinates = [](const phase_point<double, 2>& x) {
    return Eigen::Vector4d(x.q[0], x.q[1], x.p[0], x.p[1]);
  };
  const auto count = static_cast<double>(data.pairs());
  Eigen::Vector4d sigma = Eigen::Vector4d::Zero();
  for (std::size_t n = 0; n < data.pairs(); ++n) {
    sigma += (coordinates(data.finish[n]) - coordinates(data.start[n])).cwiseAbs2() / count;
  }
  const auto blocks = static_cast<Eigen::Index>(data.trajectories());
  by_hand result{Eigen::MatrixXd::Zero(2, blocks), Eigen::MatrixXd::Zero(2, blocks)};
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    const auto column = static_cast<Eigen::Index>(m);
    for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
      phase_point<double, 2> x = data.start[n];
      const auto j = appendix(S(), b1, beta1, x);
      const Eigen::Vector4d r = coordinates(x) - coordinates(data.finish[n]);
      result.gradient.col(column) += 2.0 * j.transpose() * r.cwiseQuotient(sigma) / count;
      // r is a difference of numbers below 1, and some hundred operations went into r and j.
      const Eigen::Vector4d size = (r.cwiseAbs() + Eigen::Vector4d::Ones()).cwiseQuotient(sigma);
      result.rounding.col(column) += 100.0 * eps * j.cwiseAbs().transpose() * size / count;
    }
  }
  return result;
}

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

double sum_of_sizes(const std::vector<Eigen::VectorXd>& vectors) {
  double sum = 0.0;
  for (const auto& v : vectors) sum += v.cwiseAbs().sum();
  return sum;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_gradient_is_the_papers_trajectory_by_trajectory) {
  const auto data = some_data();
  const S system;
  const metric measure(system, data, coordinates::qp);
  const one_step<nystrom> loss(system, data, measure);
  draws random;
  for (int n = 0; n < 10; ++n) {
    const auto theta = random_theta<nystrom>(random);
    const auto ours = trajectory_gradients(loss, theta);
    const auto theirs = gradient_by_hand(data, theta[0], theta[1]);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", b1 = " << theta[0] << ", beta1 = " << theta[1]) {
      BOOST_TEST(ours.size() == 7U);
      double off = 0.0;
      double off_without_two = 0.0;  // the appendix's first line
      for (std::size_t m = 0; m < ours.size(); ++m) {
        const auto column = static_cast<Eigen::Index>(m);
        const Eigen::Vector2d expected = theirs.gradient.col(column);
        const Eigen::Vector2d rounding = theirs.rounding.col(column);
        off = std::max(off, (ours[m] - expected).cwiseQuotient(rounding).cwiseAbs().maxCoeff());
        off_without_two = std::max(off_without_two,
                                   (ours[m] - 0.5 * expected).cwiseQuotient(rounding).cwiseAbs().maxCoeff());
      }
      BOOST_TEST(off <= 1.0);
      BOOST_TEST(off_without_two > 1e3);
    }
  }
}

BOOST_AUTO_TEST_CASE(parts_by_trajectory_and_by_coordinate_have_the_same_sum) {
  const auto data = some_data();
  const S system;
  const metric measure(system, data, coordinates::qp);
  const one_step<nystrom> loss(system, data, measure);
  const parameters_of<nystrom> theta{0.4, 0.35};
  const Eigen::VectorXd by_trajectory = squares_at(loss, theta).gradient();
  const auto by_coordinate = tree_sum(residual_gradients(loss, theta));
  BOOST_TEST(by_coordinate.cols() == 4);
  // 140 terms are added in another order.
  const double rounding = 140.0 * eps * by_coordinate.cwiseAbs().sum();
  BOOST_TEST((by_trajectory - by_coordinate.rowwise().sum()).cwiseAbs().maxCoeff() <= rounding);
}

BOOST_AUTO_TEST_CASE(the_gradient_is_the_slope_of_the_loss) {
  const auto data = some_data();
  const S system;
  const metric measure(system, data, coordinates::modes);
  const one_step<nystrom> loss(system, data, measure);
  const auto value = [&](const parameters_of<nystrom>& theta) { return loss_value(loss, theta); };
  draws random;
  for (int n = 0; n < 5; ++n) {
    const auto theta = random_theta<nystrom>(random);
    const Eigen::VectorXd ours = squares_at(loss, theta).gradient();
    for (std::size_t k = 0; k < 2; ++k) {
      const central_difference difference(value, theta, k);
      const double s = 1e-4;
      const double error = difference.truncation(s);
      // Each of 140 squares rounds.
      const double rounding = 140.0 * eps * loss_value(loss, theta) / s;
      const auto index = static_cast<Eigen::Index>(k);
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", b1 = " << theta[0] << ", beta1 = " << theta[1]) {
        BOOST_TEST(std::abs(ours[index] - difference(s)) <= 2.0 * error + rounding);
        BOOST_TEST(std::abs(ours[index] - difference(s)) <= 1e-5 * ours.norm());  // which says something
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_hessian_is_that_of_nested_dual_numbers) {
  const auto data = some_data();
  const S system;
  const metric measure(system, data, coordinates::qp);
  const one_step<nystrom> loss(system, data, measure);
  const sample_blocks<nystrom, S> pairs(system, data, measure);
  draws random;
  for (int n = 0; n < 3; ++n) {
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
