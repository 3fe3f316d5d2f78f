// SPDX-License-Identifier: BSL-1.0
// What tests of losses compare with: differences, data that a method made itself, and the loss over steps as
// a textbook has it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "../../src/nysalt/losses/after_steps.hpp"
#include "nysalt/family.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/method.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/noises/recorded_path.hpp"
#include "nysalt/stepper.hpp"
#include "parameters.hpp"

namespace nysalt::test {

/// The slope by differences of f at x along coordinate k: (f(x + s e_k) - f(x - s e_k))/(2 s).
template <class F, class X, class K>
class central_difference {
 public:
  central_difference(const F& f, const X& x, K k) : f_(f), x_(x), k_(k) {}

  std::invoke_result_t<F, X> operator()(double s) const {
    X ahead = x_;
    X behind = x_;
    ahead[k_] += s;
    behind[k_] -= s;
    return (f_(ahead) - f_(behind)) / (2.0 * s);
  }
  /// Truncation falls to a quarter with s, so it is a third of the change.
  double truncation(double s) const { return std::abs((*this)(s) - (*this)(2.0 * s)) / 3.0; }

 private:
  F f_;
  X x_;
  K k_;
};

/// Whether two passes over data came to the same bits.
inline bool same(const squares& a, const squares& b) {
  return a.value == b.value && a.half_gradient == b.half_gradient && a.normal_matrix == b.normal_matrix;
}

/// The contribution of each trajectory to the gradient of a loss.
inline std::vector<Eigen::VectorXd> trajectory_gradients(const loss_on_data& loss,
                                                         const Eigen::VectorXd& theta) {
  std::vector<Eigen::VectorXd> result;
  for (const auto& of_residuals : loss.gradients(theta)) result.emplace_back(of_residuals.rowwise().sum());
  return result;
}

struct steps_options {
  double step;
  std::int64_t steps = 10;  // of each trajectory
  std::int64_t trajectories = 30;
  std::uint64_t seed = 1;
  int parts = 2;  // of a step, in which its noise is told
};

/// Noise `parts` times a step, and with it a plain step of the method from each state to the next.
template <class S, Ensemble<S> E>
flow_map_data made_by_steps(const S& system, const E& ensemble, const method& method,
                            const steps_options& options) {
  using numbers = vector<double, S::dimension>;
  flow_map_data data;
  data.step = options.step;
  data.noise_parts = options.parts;
  data.system = describe(system);
  data.seed = options.seed;
  data.first_of = {0};
  const auto intervals = detail::intervals_of_noise(method.letters(), method.coefficients());
  for (std::int64_t m = 0; m < options.trajectories; ++m) {
    const auto trajectory = static_cast<std::uint64_t>(m);
    recorded_path<double, S::dimension> path(options.step / options.parts, system.bath().friction(),
                                             trajectory);
    for (std::int64_t n = 0; n < options.steps * options.parts; ++n) {
      numbers xi = detail::make_vector<double>(system);
      counter_noise(options.seed).normals(noise_place{trajectory, n, 0}, xi);
      data.noise.push_back(xi);
      path.add(std::move(xi));
    }
    const along_path<double, S::dimension> noise(path, intervals, options.step);
    const auto stepper = make_stepper(system, method, options.step, noise);
    auto x = ensemble(options.seed, trajectory);
    for (std::int64_t n = 0; n < options.steps; ++n) {
      data.start.push_back(x);
      stepper.step(x, trajectory, n);
      data.finish.push_back(x);
    }
    data.first_of.push_back(data.pairs());
  }
  return data;
}

/// The loss window after window over double, and a Ceres block for each. It shares no
/// loop with the library's own: an oracle for tests, and what benchmarks compare with. Refers to system, data
/// and metric.
template <Family F, SeparableSystem S>
class sample_blocks {
 public:
  static constexpr std::size_t parameters = static_cast<std::size_t>(F::parameters);
  using D = dual<double, F::parameters>;
  template <class C>
  using residuals = Eigen::Matrix<C, Eigen::Dynamic, 1>;

  sample_blocks(const S& system, const flow_map_data& data, const metric& measure,
                const after_steps_options& options = {})
      : system_(&system), data_(&data), metric_(&measure), options_(options) {
    const auto steps = static_cast<std::size_t>(options.steps.back());
    for (std::size_t m = 0; m < data.trajectories(); ++m) {
      std::size_t pair = data.first_of[m];
      while (pair + steps <= data.first_of[m + 1]) {
        windows_.push_back({m, pair});
        pair += static_cast<std::size_t>(options.apart);
      }
    }
  }

  std::size_t windows() const { return windows_.size(); }
  int residuals_of_window() const { return static_cast<int>(metric_->residuals()); }

  /// The residuals of one window over double, or anything that carries derivatives by theta.
  template <Scalar C>
  residuals<C> at(std::size_t window, const std::array<C, parameters>& theta) const {
    const auto c = F::coefficients(theta);
    const stepper<S, C> one(*system_, F::letters, {c.begin(), c.end()}, data_->step);
    const std::size_t pair = windows_[window].first_pair;
    const phase_point<double, S::dimension> first = data_->start[pair];
    auto x = first.template cast<C>();
    const std::vector<int>& steps = options_.steps;
    residuals<C> r(residuals_of_window() * std::ssize(steps));
    auto run = one.open(x);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      if (steps.back() == 1) {
        one.step(x);
      } else {
        one.advance(run, steps[k] - run.step);
        x = one.synchronous(run);
      }
      const auto last = pair + static_cast<std::size_t>(steps[k]) - 1;
      metric_->residual(x.q, x.p, data_->finish[last],
                        r.data() + static_cast<Eigen::Index>(k) * residuals_of_window());
    }
    return r;
  }

  static std::array<D, parameters> with_derivatives(const double* theta) {
    std::array<D, parameters> result;
    for (std::size_t k = 0; k < parameters; ++k) result[k] = D::variable(theta[k], static_cast<int>(k));
    return result;
  }

  /// The mean over windows, by trajectory: a window's terms are added first, then those of a trajectory.
  std::vector<squares> by_trajectory(const std::array<double, parameters>& theta) const {
    const auto lifted = with_derivatives(theta.data());
    const squares zero{0.0, Eigen::VectorXd::Zero(F::parameters),
                       Eigen::MatrixXd::Zero(F::parameters, F::parameters)};
    std::vector<squares> result(data_->trajectories(), zero);
    for (std::size_t n = 0; n < windows(); ++n) {
      squares of_window = zero;
      for (const D& r : at(n, lifted)) add(of_window, r);
      add(result[windows_[n].trajectory], of_window);
    }
    const double share = 1.0 / static_cast<double>(windows() * options_.steps.size());
    for (auto& part : result) {
      part.value *= share;
      part.half_gradient *= share;
      part.normal_matrix *= share;
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

  struct window {
    std::size_t trajectory;
    std::size_t first_pair;
  };

  const S* system_;
  const flow_map_data* data_;
  const metric* metric_;
  after_steps_options options_;
  std::vector<window> windows_;
};

}  // namespace nysalt::test
