// SPDX-License-Identifier: BSL-1.0
// Choice of a loss to learn with.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "nysalt/bath.hpp"
#include "nysalt/losses/loss_kind.hpp"

namespace nysalt {

/// A loss and its number of steps; by default that of trajectories.
struct loss_choice {
  const loss_kind* kind = losses().front();  ///< kind of the loss
  int steps = 1;                             ///< K; of no account where the kind counts no steps

  friend bool operator==(const loss_choice&, const loss_choice&) = default;  ///< equal in both

  /// The text that loss_named() reads, such as "state:1".
  std::string description() const;
};

/// The default loss: that of trajectories; in a bath that of one step, as
/// friction and noise make an end of phases, and what trajectories gain in phase they lose in the
/// distribution of energies.
loss_choice usual_loss(const bath& around);

/// "state:5", "energy:10", "covariance"; K is 1 where it is not said. Throws std::invalid_argument for
/// anything else.
loss_choice loss_named(std::string_view text);

/// Parses the name of a loss; empty for other text.
std::optional<loss_choice> find_loss(std::string_view text);

/// The names that loss_named() reads, such as "state:K, energy:K": of the losses that count steps, or of the
/// others.
std::string loss_patterns(bool count_steps);

}  // namespace nysalt
