// SPDX-License-Identifier: BSL-1.0
// The losses of the library and the program: what each needs, and which is chosen.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/bath.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/model.hpp"
#include "nysalt/run_time_family.hpp"

namespace nysalt {

namespace detail {
struct data_loss;    // in src/nysalt/losses/data_loss.hpp
struct loss_inputs;  // there, too
}  // namespace detail

/// The criterion that is least for the best of several minima: the loss on held-out data; the state's error
/// at the ends of held-out trajectories; or the loss on the data that were learned from, so that held-out
/// data choose nothing.
enum class judge_of_minima { held_out_loss, held_out_end, training_loss };

/// The error after K steps, from four states of each trajectory first, then from each.
std::vector<after_steps_options> after_each_step(int K, int shortest);

/// A loss that text can name: what it needs, how it is made, and how it is judged. Each is declared in one
/// file, src/nysalt/losses/NAME.cpp, and listed in losses.cpp there.
struct loss_kind {
  std::string_view name;     ///< name, as in "state:K"
  bool counts_steps = true;  ///< the number K of steps follows the name
  bool needs_modes = false;  ///< whether the loss needs the modes of the system
  bool needs_bath = false;   ///< whether the loss needs a bath with friction and temperature
  judge_of_minima judge = judge_of_minima::held_out_loss;  ///< criterion that chooses among several minima
  bool is_of_energy_norm = false;  ///< errors count in the energy coordinates where these exist, else in qp
  bool is_of_proposals =
      false;  ///< trajectories are proposals: no run takes more steps than those of the data
  bool is_for_sampling = false;  ///< whether words that are only volume-preserving may be learned by the loss
  bool is_shortened = false;     ///< over a quarter of the steps, and again, where no method follows the data
  /// Numbers of steps after which errors count, in trajectories of `shortest` steps or more: what a search
  /// minimises first, ..., and last the loss itself. K follows the name.
  std::vector<after_steps_options> (*stages)(int K, int shortest) = after_each_step;
  /// The loss over data; where the loss itself asks none, the estimate of what was learned from held-out
  /// data.
  detail::data_loss (*over_data)(const detail::loss_inputs& from);
  /// The loss of a step, if it asks no data; else nullptr.
  objective (*without_data)(const model& system, const run_time_family& family, double step) = nullptr;

  constexpr bool asks_data() const {
    return without_data == nullptr;
  }  ///< whether the loss is minimised over data
};

/// All losses; the first is the default.
std::span<const loss_kind* const> losses();

// Choice of a loss to learn with.

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
