// SPDX-License-Identifier: BSL-1.0
// What the library and the program know of a loss.
#pragma once

#include <span>
#include <string_view>

#include "nysalt/losses/squares.hpp"
#include "nysalt/model.hpp"
#include "nysalt/run_time_family.hpp"

namespace nysalt {

namespace detail {
struct data_loss;    // in src/nysalt/losses/data_loss.hpp
struct loss_inputs;  // there, too
}  // namespace detail

/// A loss that text can name: what it needs, how it is made, and how it is judged. Each is declared in one
/// file, src/nysalt/losses/NAME.cpp, and listed in losses.cpp there.
struct loss_kind {
  std::string_view name;      ///< as in "state:K"
  bool counts_steps = true;   ///< the number K of steps stands behind its name
  bool needs_modes = false;   ///< of the system
  bool needs_bath = false;    ///< with friction and temperature
  bool is_of_states = false;  ///< several minima are judged by the state's error at the ends of the held-out
                              ///< trajectories, not by the loss itself on the held-out data
  /// The loss over data; where the loss itself asks none, what held-out data tell of what was learned.
  detail::data_loss (*over_data)(const detail::loss_inputs& from);
  /// The loss of a step, if it asks no data; else nullptr.
  objective (*without_data)(const model& system, const run_time_family& family, double step) = nullptr;

  constexpr bool asks_data() const { return without_data == nullptr; }  ///< it is minimised over data
};

/// All losses; the first is the default.
std::span<const loss_kind* const> losses();

}  // namespace nysalt
