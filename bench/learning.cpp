// SPDX-License-Identifier: BSL-1.0
// A search over 10^5 samples: compressed to one small block, against a Ceres block for each sample.
#include <benchmark/benchmark.h>
#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../src/nysalt/learning/minimise.hpp"
#include "../tests/support/losses.hpp"
#include "../tests/support/parameters.hpp"
#include "counting.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/stepper.hpp"
#include "peers/roofs.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

using chain_type = fpu_chain<3>;
constexpr std::int64_t pairs_each = 100;
constexpr std::int64_t trajectories = 1000;

/// One window of test::sample_blocks as a Ceres cost.
template <class Blocks>
class sample_cost final : public ceres::CostFunction {
 public:
  sample_cost(const Blocks& blocks, std::size_t window, theta_condition defined)
      : blocks_(&blocks),
        window_(window),
        defined_(std::move(defined)),
        share_(1.0 / std::sqrt(static_cast<double>(blocks.windows()))) {
    set_num_residuals(blocks.residuals_of_window());
    mutable_parameter_block_sizes()->push_back(static_cast<int>(Blocks::parameters));
  }

  bool Evaluate(double const* const* at, double* residuals, double** jacobians) const override {
    constexpr std::size_t count = Blocks::parameters;
    std::array<double, count> theta;
    for (std::size_t k = 0; k < count; ++k) theta[k] = at[0][k];
    if (defined_ && !defined_(test::column_of(theta))) return false;
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      for (const double r : blocks_->at(window_, theta)) *residuals++ = r * share_;
      return true;
    }
    double* slope = jacobians[0];
    for (const auto& r : blocks_->at(window_, Blocks::with_derivatives(at[0]))) {
      *residuals++ = r.value * share_;
      for (const double d : r.derivative) *slope++ = d * share_;
    }
    return true;
  }

 private:
  const Blocks* blocks_;
  std::size_t window_;
  theta_condition defined_;
  double share_;
};

/// What minimise() does, block by block.
template <class Blocks>
minimum minimise_by_blocks(const Blocks& blocks, const theta_condition& defined, const Eigen::VectorXd& start,
                           const std::vector<Eigen::Index>& free, int max_iterations) {
  minimum found{start};
  ceres::Problem problem;
  for (std::size_t n = 0; n < blocks.windows(); ++n) {
    problem.AddResidualBlock(new sample_cost<Blocks>(blocks, n, defined), nullptr, found.theta.data());
  }
  nysalt::detail::descend(problem, free, {max_iterations}, found);
  nysalt::detail::polish(std::cref(blocks), defined, free, found);
  return found;
}

/// All that both searches share; it stays where it is, as the losses refer to it.
class problem {
 public:
  problem()
      : data_(make_flow_map_data(chain_, fpu_law<3>(chain_), fine_steps(1e-3),
                                 {.step = 0.01, .horizon = 0.01 * pairs_each, .trajectories = trajectories})),
        measure_(chain_, data_, coordinates::qp) {}

  minimum compressed() const {
    return minimise(detail::objective_of(*loss()), defined_, start_, {0, 1}, iterations_);
  }
  minimum block_per_sample() const {
    const test::sample_blocks<nystrom, chain_type> blocks(chain_, data_, measure_);
    return minimise_by_blocks(blocks, defined_, start_, {0, 1}, iterations_);
  }
  double samples() const { return static_cast<double>(data_.pairs()); }

  /// One pass over the data: loss, gradient and normal matrix.
  squares pass(const after_steps<>& loss) const { return loss.at(start_); }
  std::shared_ptr<const after_steps<>> loss() const {
    return std::make_shared<const after_steps<>>(family_, model(chain_), data_, state_error(measure_));
  }

  /// Multiplications and additions that a pass does for one pair, counted: a step with two derivatives, the
  /// residuals, and the six terms that these add to the sums of the trajectory.
  std::int64_t operations_of_pair() const {
    using C = dual<counting, 2>;
    const auto c =
        nystrom::coefficients(std::array{C::variable(counting(0.5), 0), C::variable(counting(0.4), 1)});
    const stepper<chain_type, C> one(chain_, nystrom::letters, {c.begin(), c.end()}, data_.step);
    const phase_point<double, Eigen::Dynamic> first = data_.start[0];
    auto x = phase_point<double, 6>{first.q, first.p}.cast<C>();
    const phase_point<double, Eigen::Dynamic> last = data_.finish[0];
    const auto wanted = last.cast<counting>();
    std::vector<C> r(static_cast<std::size_t>(measure_.residuals()));
    std::array<counting, 6> terms;
    counting::multiplied = counting::added = 0;
    one.step(x);
    measure_.residual(x.q, x.p, wanted, r.data());
    for (const C& one_of : r) {
      const auto& [value, slope] = one_of;
      std::size_t term = 0;
      terms[term++] += value * value;
      for (const counting& s : slope) terms[term++] += s * value;
      terms[term++] += slope[0] * slope[0];
      terms[term++] += slope[0] * slope[1];
      terms[term++] += slope[1] * slope[1];
    }
    return counting::multiplied + counting::added;
  }
  /// All numbers of the data side by side.
  std::vector<double> numbers() const {
    std::vector<double> result;
    for (const auto* states : {&data_.start, &data_.finish}) {
      for (const auto& x : *states) {
        for (const auto& part : {x.q, x.p}) result.insert(result.end(), part.begin(), part.end());
      }
    }
    return result;
  }

 private:
  static constexpr int iterations_ = 200;
  family family_{nystrom()};
  theta_condition defined_ = [this](const Eigen::VectorXd& theta) { return family_.is_defined(theta); };
  chain_type chain_{50.0};
  flow_map_data data_;
  metric measure_;
  Eigen::VectorXd start_ = test::column_of(nystrom::start());
};

/// What is asked of the learner: the loss equal to 1e-10, theta to 1e-8.
void require_same_minimum(const minimum& ours, const minimum& theirs) {
  const double loss = std::abs(ours.loss - theirs.loss) / theirs.loss;
  const double theta = (ours.theta - theirs.theta).norm();
  std::printf("learning: losses differ by %.1e, theta by %.1e\n", loss, theta);
  if (ours.converged && theirs.converged && loss <= 1e-10 && theta <= 1e-8) return;
  throw std::runtime_error(fmt::format(
      "the searches end at different minima: the losses differ by {:.1e}, theta by {:.1e}", loss, theta));
}

}  // namespace

void race_learning() {
  const auto shared = std::make_shared<problem>();
  require_same_minimum(shared->compressed(), shared->block_per_sample());
  std::vector<runner> runners;
  runners.push_back({"compressed", shared->samples(), [shared] { shared->compressed(); }});
  runners.push_back({"block per sample", shared->samples(), [shared] { shared->block_per_sample(); }});
  race("learning", std::move(runners), {.turn_seconds = 0.0, .repetitions = 3});
}

/// One pass of the learner, beside as much arithmetic in registers and the reading of its data.
void race_learning_pass() {
  const auto shared = std::make_shared<problem>();
  const auto loss = shared->loss();
  const auto numbers = std::make_shared<const std::vector<double>>(shared->numbers());
  const double operations = static_cast<double>(shared->operations_of_pair()) * shared->samples();
  const auto steps =
      static_cast<std::int64_t>(operations / (pack<double>::lanes * (multiplications + additions)));
  std::printf("learning pass: %lld operations a pair\n",
              static_cast<long long>(shared->operations_of_pair()));
  std::vector<runner> runners;
  runners.push_back({"pass", shared->samples(), [=] { benchmark::DoNotOptimize(shared->pass(*loss)); }});
  runners.push_back({"same number of operations", shared->samples(),
                     [=] { benchmark::DoNotOptimize(mix_kernel<contraction::off>(steps)); }});
  runners.push_back({"reading the data alone", shared->samples(), [=] {
                       const Eigen::Map<const Eigen::VectorXd> all(numbers->data(), std::ssize(*numbers));
                       benchmark::DoNotOptimize(all.sum());
                     }});
  race("learning pass", std::move(runners));
}

}  // namespace nysalt::bench
