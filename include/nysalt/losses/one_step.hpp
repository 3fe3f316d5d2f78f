// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/losses/metric.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt {

/// The paper's loss [li_lu_tao_ye_2023, equation (3.5)]: the mean over all pairs of
/// sum over coordinates of r^2 / Sigma, with r the error of one step from `start` to `finish`.
///
/// A block is one trajectory, whose pairs depend on each other; blocks are independent.
/// What a loss offers the learner: blocks(), residuals(block), evaluate(block, theta, r).
template <Family F, SeparableSystem S>
class one_step {
 public:
  using family = F;

  /// Refers to all three.
  one_step(const S& system, const flow_map_data<S::dimension>& data, const metric<S::dimension>& measure)
      : system_(&system), data_(&data), metric_(&measure) {}

  std::size_t blocks() const { return data_->trajectories(); }
  std::size_t residuals(std::size_t block) const {
    return (data_->first_of[block + 1] - data_->first_of[block]) *
           static_cast<std::size_t>(metric_->residuals());
  }

  /// The residuals of a block over double, or over dual numbers that carry derivatives by theta; the loss
  /// is the sum of all their squares. Throws nothing: inadmissible theta give what arithmetic gives.
  template <Scalar C>
  void evaluate(std::size_t block, const std::array<C, static_cast<std::size_t>(F::parameters)>& theta,
                C* r) const {
    using word = typename F::word;
    const stepper<S, word, C> one(*system_, F::coefficients(theta), data_->step);
    flow_state<C, S::dimension> x{{make_vector<C>(*system_), make_vector<C>(*system_)},
                                  make_vector<C>(*system_)};
    const double share = 1.0 / std::sqrt(static_cast<double>(data_->pairs()));
    const Eigen::Index rows = metric_->residuals();
    for (std::size_t n = data_->first_of[block]; n < data_->first_of[block + 1]; ++n) {
      const auto& start = data_->start[n];
      for (Eigen::Index i = 0; i < start.size(); ++i) {
        x.q[i] = C(start.q[i]);
        x.p[i] = C(start.p[i]);
      }
      one.step(x);
      metric_->residual(x.q, x.p, data_->finish[n], r);
      for (Eigen::Index k = 0; k < rows; ++k) r[k] = r[k] * share;
      r += rows;
    }
  }

 private:
  const S* system_;
  const flow_map_data<S::dimension>* data_;
  const metric<S::dimension>* metric_;
};

}  // namespace nysalt
