// SPDX-License-Identifier: BSL-1.0
// The residuals of a window of steps.
#pragma once

#include <cstddef>
#include <functional>

#include "nysalt/losses/windows_in_lanes.hpp"

namespace nysalt {

/// Residuals of a loss over data, of any kind: state_error(), energy_error(), own_error().
/// The kind is no part of the type, as a pass over the data is expensive to compile: one serves all kinds. It
/// calls `of` once for each pack of windows and each two parameters, which costs little beside their steps.
template <Scalar R = detail::lanes>
struct window_error {
  using scalar = dual<R, directions_at_a_time>;       ///< residuals with their derivatives
  using data_point = phase_point<R, Eigen::Dynamic>;  ///< states of the data, in the lanes of R
  using point = phase_point<scalar, Eigen::Dynamic>;  ///< a state that the method comes to

  std::size_t residuals;  ///< number of residuals of a window
  /// Writes r[0..residuals) of the window from start, which the method ends at finish, and the data at
  /// wanted. Called from several threads at a time.
  std::function<void(const data_point& start, const point& finish, const data_point& wanted, scalar* r)> of;
  /// Errors of weights that are estimated from the data: row k, column m is what trajectory m adds to the
  /// relative error of residual k's mean square. Else nullptr.
  const Eigen::MatrixXd* weight_deviations = nullptr;
  bool may_throw = false;  ///< whether `of` may, so that ranks that share the data must agree on it
};

}  // namespace nysalt
