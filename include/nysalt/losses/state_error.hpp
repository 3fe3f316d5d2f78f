// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/losses/metric.hpp"
#include "nysalt/losses/window_error.hpp"

namespace nysalt {

/// r = Sigma^{-1/2} (K steps from the start - the data there); for K = 1 the paper's loss
/// [li_lu_tao_ye_2023, equation (3.5)]. Refers to the metric, whose weights are estimates.
template <Scalar R = detail::lanes>
window_error<R> state_error(const metric& measure) {
  return {.residuals = static_cast<std::size_t>(measure.residuals()),
          .of = [error_metric = &measure](const auto&, const auto& finish, const auto& wanted,
                                          auto* r) { error_metric->residual(finish.q, finish.p, wanted, r); },
          .weight_deviations = &measure.weight_deviations()};
}

/// A metric that is gone by then cannot be referred to.
template <Scalar R = detail::lanes>
window_error<R> state_error(metric&& measure) = delete;

}  // namespace nysalt
