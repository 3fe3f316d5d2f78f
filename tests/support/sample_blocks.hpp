// SPDX-License-Identifier: BSL-1.0
// The one-step loss as a textbook has it: pair after pair over double, and a Ceres block for each. It shares
// no loop with the library's own: an oracle for tests, and what benchmarks compare with.
#pragma once

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/learning/minimise.hpp"
#include "nysalt/losses/metric.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt::test {

/// Refers to all three.
template <Family F, SeparableSystem S>
class sample_blocks {
  static constexpr int most = S::dimension == Eigen::Dynamic ? Eigen::Dynamic : 2 * S::dimension;

 public:
  static constexpr std::size_t parameters = static_cast<std::size_t>(F::parameters);
  using D = dual<double, F::parameters>;
  template <class C>
  using residuals = Eigen::Matrix<C, Eigen::Dynamic, 1, 0, most, 1>;

  sample_blocks(const S& system, const flow_map_data<S::dimension>& data, const metric<S::dimension>& measure)
      : system_(&system), data_(&data), metric_(&measure) {}

  std::size_t pairs() const { return data_->pairs(); }
  int residuals_of_pair() const { return static_cast<int>(metric_->residuals()); }

  /// The residuals of one pair over double, or anything that carries derivatives by theta.
  template <Scalar C>
  residuals<C> at(std::size_t pair, const std::array<C, parameters>& theta) const {
    const stepper<S, typename F::word, C> one(*system_, F::coefficients(theta), data_->step);
    auto x = data_->start[pair].template cast<C>();
    one.step(x);
    residuals<C> r(metric_->residuals());
    metric_->residual(x.q, x.p, data_->finish[pair], r.data());
    return r;
  }

  static std::array<D, parameters> with_derivatives(const double* theta) {
    std::array<D, parameters> result;
    for (std::size_t k = 0; k < parameters; ++k) result[k] = D::variable(theta[k], static_cast<int>(k));
    return result;
  }

  /// The mean over pairs, by trajectory: a pair's terms are added first, then those of a trajectory.
  std::vector<squares> by_trajectory(const std::array<double, parameters>& theta) const {
    const auto lifted = with_derivatives(theta.data());
    const squares zero{0.0, Eigen::VectorXd::Zero(F::parameters),
                       Eigen::MatrixXd::Zero(F::parameters, F::parameters)};
    std::vector<squares> result(data_->trajectories(), zero);
    for (std::size_t m = 0; m < result.size(); ++m) {
      for (std::size_t pair = data_->first_of[m]; pair < data_->first_of[m + 1]; ++pair) {
        squares of_pair = zero;
        for (const D& r : at(pair, lifted)) add(of_pair, r);
        add(result[m], of_pair);
      }
      const double share = 1.0 / static_cast<double>(pairs());
      result[m].value *= share;
      result[m].half_gradient *= share;
      result[m].normal_matrix *= share;
    }
    return result;
  }

  /// The whole loss.
  squares operator()(const Eigen::VectorXd& theta) const {
    std::vector<double> values;
    std::vector<Eigen::VectorXd> half_gradients;
    std::vector<Eigen::MatrixXd> normal_matrices;
    for (const auto& part : by_trajectory(array_of<parameters>(theta))) {
      values.push_back(part.value);
      half_gradients.push_back(part.half_gradient);
      normal_matrices.push_back(part.normal_matrix);
    }
    return {tree_sum(values), tree_sum(half_gradients), tree_sum(normal_matrices)};
  }

 private:
  static void add(squares& sum, const D& r) {
    sum.value += r.value * r.value;
    for (Eigen::Index i = 0; i < F::parameters; ++i) {
      const double slope = r.derivative[static_cast<std::size_t>(i)];
      sum.half_gradient[i] += slope * r.value;
      for (Eigen::Index j = 0; j < F::parameters; ++j) {
        sum.normal_matrix(i, j) += slope * r.derivative[static_cast<std::size_t>(j)];
      }
    }
  }
  static void add(squares& sum, const squares& term) {
    sum.value += term.value;
    sum.half_gradient += term.half_gradient;
    sum.normal_matrix += term.normal_matrix;
  }

  const S* system_;
  const flow_map_data<S::dimension>* data_;
  const metric<S::dimension>* metric_;
};

/// One pair as a Ceres cost.
template <class Blocks>
class sample_cost final : public ceres::CostFunction {
 public:
  sample_cost(const Blocks& blocks, std::size_t pair, std::function<bool(const Eigen::VectorXd&)> defined)
      : blocks_(&blocks),
        pair_(pair),
        defined_(std::move(defined)),
        share_(1.0 / std::sqrt(static_cast<double>(blocks.pairs()))) {
    set_num_residuals(blocks.residuals_of_pair());
    mutable_parameter_block_sizes()->push_back(static_cast<int>(Blocks::parameters));
  }

  bool Evaluate(double const* const* at, double* residuals, double** jacobians) const override {
    constexpr std::size_t count = Blocks::parameters;
    std::array<double, count> theta;
    for (std::size_t k = 0; k < count; ++k) theta[k] = at[0][k];
    if (defined_ && !defined_(column_of(theta))) return false;
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      for (const double r : blocks_->at(pair_, theta)) *residuals++ = r * share_;
      return true;
    }
    double* slope = jacobians[0];
    for (const auto& r : blocks_->at(pair_, Blocks::with_derivatives(at[0]))) {
      *residuals++ = r.value * share_;
      for (const double d : r.derivative) *slope++ = d * share_;
    }
    return true;
  }

 private:
  const Blocks* blocks_;
  std::size_t pair_;
  std::function<bool(const Eigen::VectorXd&)> defined_;
  double share_;
};

/// What minimise() does, block by block.
template <class Blocks>
minimum minimise_by_blocks(const Blocks& blocks, const std::function<bool(const Eigen::VectorXd&)>& defined,
                           const Eigen::VectorXd& start, const std::vector<Eigen::Index>& free,
                           int max_iterations) {
  minimum found{start};
  ceres::Problem problem;
  for (std::size_t pair = 0; pair < blocks.pairs(); ++pair) {
    problem.AddResidualBlock(new sample_cost<Blocks>(blocks, pair, defined), nullptr, found.theta.data());
  }
  found.iterations = nysalt::detail::search(problem, found.theta, free, max_iterations);
  nysalt::detail::polish(std::cref(blocks), defined, free, found);
  return found;
}

}  // namespace nysalt::test
