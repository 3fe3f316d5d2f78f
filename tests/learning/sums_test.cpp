// SPDX-License-Identifier: BSL-1.0
// What is learned is the same to the bit in any number of lanes and threads, and sums over trajectories are
// added in the order of tree_sum.
#include <boost/test/unit_test.hpp>

#include "../support/in_lanes.hpp"
#include "../support/one_step.hpp"
#include "../support/sample_blocks.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const fpu_chain<3> chain(50.0);
constexpr parameters_of<nystrom> theta{0.45, 0.38};

flow_map_data data_of(std::uint64_t seed, int threads) {
  return make_flow_map_data(
      chain, fpu_law<3>(chain), fine_steps<>(1e-3),
      {.step = 0.02, .horizon = 0.1, .trajectories = 203, .seed = seed, .threads = threads});
}

/// All numbers of a summary but the seconds, in full.
std::string digits_of(const fit_summary& fit) {
  std::string text;
  for (const auto& p : fit.parameters) text += fmt::format("{:a} +- {:a}\n", p.value, p.standard_error);
  text += fmt::format("{:a} {:a} {:a}\n", fit.loss, fit.held_out_loss, fit.held_out_start_loss);
  text += fmt::format("{:a} {:a} {:a}\n", fit.one_step_error, fit.reference_error, fit.condition);
  text += fmt::format("{} {}", fit.iterations, fit.learning_evaluations);
  return text;
}

/// Term after term: the order that is not ours.
template <class T>
T sum_in_order(const std::vector<T>& terms) {
  T sum = terms.front();
  for (std::size_t m = 1; m < terms.size(); ++m) sum += terms[m];
  return sum;
}

}  // namespace

/// Of trajectories one at a time, or as many side by side as suit the processor.
template <int lanes>
std::string digits_learned(coordinates which, int threads, std::uint64_t seed) {
  const auto data = data_of(seed, threads);
  const auto held_out = data_of(seed + 1, threads);
  const in_lanes<fpu_chain<3>, lanes> system(chain);
  return digits_of(
      learn(nystrom{}, system, data, held_out, {.coordinates = which, .threads = threads}).summary);
}

BOOST_AUTO_TEST_CASE(lanes_and_threads_change_no_bit_of_what_is_learned) {
  for (const auto which : {coordinates::qp, coordinates::modes}) {
    const auto one = digits_learned<1>(which, 1, 1);
    for (const int threads : {1, 2, 3}) {
      BOOST_TEST(digits_learned<default_lanes>(which, threads, 1) == one);
    }
    BOOST_TEST(digits_learned<1>(which, 2, 1) == one);
    BOOST_TEST(digits_learned<1>(which, 1, 3) != one);
  }
}

BOOST_AUTO_TEST_CASE(loss_and_gradient_are_summed_over_trajectories_in_a_tree) {
  const auto data = data_of(1, 1);
  const metric measure(chain, data, coordinates::qp);
  const one_step<nystrom> loss(chain, data, measure);
  const sample_blocks<nystrom, fpu_chain<3>> pairs(chain, data, measure);
  int losses_differ = 0;
  int gradients_differ = 0;
  for (const double beta1 : {0.36, 0.37, 0.38, 0.39, 0.40}) {
    const parameters_of<nystrom> at{0.45, beta1};
    std::vector<double> losses;
    std::vector<Eigen::VectorXd> gradients;
    for (const auto& part : pairs.by_trajectory(at)) {
      losses.push_back(part.value);
      gradients.push_back(part.gradient());
    }
    const Eigen::VectorXd gradient = squares_at(loss, at).gradient();
    BOOST_TEST(loss_value(loss, at) == tree_sum(losses));
    BOOST_TEST((gradient == tree_sum(gradients)));
    losses_differ += loss_value(loss, at) != sum_in_order(losses);
    gradients_differ += gradient != sum_in_order(gradients);
  }
  BOOST_TEST(losses_differ > 0);  // not always, but another order has other bits
  BOOST_TEST(gradients_differ > 0);
}

BOOST_AUTO_TEST_CASE(weights_are_summed_over_trajectories_in_a_tree) {
  const auto data = data_of(1, 1);
  const metric measure(chain, data, coordinates::qp);
  std::vector<Eigen::VectorXd> squares;
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    squares.push_back(Eigen::VectorXd::Zero(12));
    for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
      for (Eigen::Index i = 0; i < 6; ++i) {
        const double dq = data.finish[n].q[i] - data.start[n].q[i];
        const double dp = data.finish[n].p[i] - data.start[n].p[i];
        squares[m][i] += dq * dq / static_cast<double>(data.pairs());
        squares[m][6 + i] += dp * dp / static_cast<double>(data.pairs());
      }
    }
  }
  const auto weights_of = [](const Eigen::VectorXd& sigma) {
    Eigen::VectorXd weights = sigma;
    for (double& x : weights) x = 1.0 / std::sqrt(x);  // Eigen's own roots round differently
    return weights;
  };
  const vector<double, 6> ones = vector<double, 6>::Ones();
  const phase_point<double, 6> zero{vector<double, 6>::Zero(), vector<double, 6>::Zero()};
  Eigen::VectorXd weights(12);
  measure.residual(ones, ones, zero, weights.data());
  BOOST_TEST((weights == weights_of(tree_sum(squares))));
  BOOST_TEST((weights != weights_of(sum_in_order(squares))));
}

BOOST_AUTO_TEST_CASE(standard_errors_are_summed_over_trajectories_in_a_tree) {
  const auto data = data_of(1, 1);
  const metric measure(chain, data, coordinates::qp);
  const one_step<nystrom> loss(chain, data, measure);
  const curvature bend(hessian(loss, theta), {0, 1});
  const auto scores = trajectory_gradients(loss, theta);
  std::vector<Eigen::VectorXd> squares;
  for (const auto& score : scores) squares.push_back(bend.solve(score).cwiseAbs2());
  const auto errors_of = [](const Eigen::VectorXd& sum) {
    return Eigen::VectorXd((sum * (203.0 / 202.0)).cwiseSqrt());
  };
  BOOST_TEST((bend.standard_errors(scores) == errors_of(tree_sum(squares))));
  BOOST_TEST((bend.standard_errors(scores) != errors_of(sum_in_order(squares))));
}

BOOST_AUTO_TEST_CASE(the_error_of_the_reference_is_summed_over_trajectories_in_a_tree) {
  int differ = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto data = data_of(seed, 1);
    const auto fit =
        learn(nystrom{}, chain, data, data, {.coordinates = coordinates::qp, .fixed = {theta[0], theta[1]}})
            .summary;
    const metric measure(chain, data, coordinates::qp);
    std::vector<double> squares(203, 0.0);
    std::vector<double> r(12);
    BOOST_TEST(data.finer.size() == 16U);
    for (const auto& [pair, finish] : data.finer) {
      measure.residual(finish.q, finish.p, data.finish[pair], r.data());
      for (const double x : r) squares[pair / 5] += x * x;  // five steps a trajectory
    }
    BOOST_TEST(fit.reference_error == std::sqrt(tree_sum(squares) / 16.0));
    differ += fit.reference_error != std::sqrt(sum_in_order(squares) / 16.0);
  }
  BOOST_TEST(differ > 0);
}
