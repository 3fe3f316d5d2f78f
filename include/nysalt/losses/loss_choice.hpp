// SPDX-License-Identifier: BSL-1.0
// Which loss to learn with.
#pragma once

#include <string>
#include <string_view>

namespace nysalt {

/// state       the state's error after K steps; K = 1 is the paper's loss, and the default
/// energy      the energy's error after K steps
/// covariance  of a thermostatted word, that of its stationary covariance: no data are asked
struct loss_choice {
  /// Of the state, of the energy, or of the stationary covariance.
  enum class kind { state, energy, covariance };
  kind of = kind::state;  ///< what the loss is of
  int steps = 1;          ///< K; of no account for a covariance

  friend bool operator==(const loss_choice&, const loss_choice&) = default;  ///< equal in both

  /// The text that loss_named() reads, such as "state:1".
  std::string description() const;
};

/// "state:5", "energy:10", "covariance"; K is 1 where it is not said. Throws std::invalid_argument for
/// anything else.
loss_choice loss_named(std::string_view text);

}  // namespace nysalt
