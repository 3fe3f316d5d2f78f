// SPDX-License-Identifier: BSL-1.0
// The losses of the library and the program: what each needs, and which is chosen.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/bath.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/family.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// Numbers of steps after which an error counts.
struct after_steps_options {
  std::vector<int> steps{1};      ///< rising numbers; the last is the length K of a window
  int apart = 1;                  ///< steps from the beginning of one window to the beginning of the next
  int every = 1;                  ///< trajectory counts whose number this divides
  nysalt::execution execution{};  ///< the number of threads; the ranks are the ranks of the data
};

namespace detail {

/// The error after K steps, from four states of each trajectory first, then from each.
std::vector<after_steps_options> after_each_step(int K, int shortest);

}  // namespace detail

/// A kind of loss: what it needs, how it is made, and how it is judged.
struct loss_kind {
  /// From what a loss over data is made. The loss copies the data, and refers to the metric.
  struct inputs {
    const nysalt::family& family;  ///< family to fit
    const model& system;           ///< system that the data are of
    const flow_map_data& data;     ///< data to sum over
    const metric& measure;         ///< weights of an error of the state
    after_steps_options how;       ///< steps after which an error counts
    bool in_lanes;                 ///< whether windows are in lanes
  };

  /// The criterion that is least for the best of several minima: the loss on held-out data; the state's error
  /// at the ends of held-out trajectories; or the loss on the data that were learned from, so that held-out
  /// data choose nothing.
  enum class judge_of_minima { held_out_loss, held_out_end, training_loss };

  std::string name;          ///< name, as in "state:K"
  bool counts_steps = true;  ///< the number K of steps follows the name
  bool needs_modes = false;  ///< whether the loss needs the modes of the system
  bool needs_bath = false;   ///< whether the loss needs a bath with friction and temperature
  judge_of_minima judge = judge_of_minima::held_out_loss;  ///< criterion that chooses among several minima
  bool is_of_energy_norm = false;  ///< errors count in the energy coordinates where these exist, else in qp
  bool is_of_proposals = false;    ///< trajectories are proposals: no run takes more steps than the data have
  bool is_for_sampling = false;  ///< whether words that are only volume-preserving may be learned by the loss
  bool is_shortened = false;     ///< over a quarter of the steps, and again, where no method follows the data
  /// Numbers of steps after which errors count, in trajectories of `shortest` steps or more: what a search
  /// minimises first, ..., and last the loss itself. K follows the name.
  std::vector<after_steps_options> (*stages)(int K, int shortest) = detail::after_each_step;
  /// The loss over data; where the loss itself asks none, the estimate of what was learned from held-out
  /// data.
  std::function<std::unique_ptr<const loss_on_data>(const inputs& from)> over_data;
  /// The loss of a step, if it asks no data; else nullptr.
  objective (*without_data)(const model& system, const nysalt::family& family, double step) = nullptr;

  bool asks_data() const { return without_data == nullptr; }  ///< whether the loss is minimised over data
};

/// All losses that text can name, a table in src/nysalt/losses/losses.cpp; the first is the default.
std::span<const std::shared_ptr<const loss_kind>> losses();

// Choice of a loss to learn with.

/// A loss and its number of steps; by default the loss `trajectory`.
struct loss_choice {
  std::shared_ptr<const loss_kind> kind = losses().front();  ///< kind of the loss
  int steps = 1;  ///< K; of no account where the kind counts no steps

  friend bool operator==(const loss_choice&, const loss_choice&) = default;  ///< equal in both

  /// The text that loss_named() reads, such as "state:1".
  std::string description() const;
};

/// The default loss: `trajectory`; in a bath the loss of one step, as
/// friction and noise make an end of phases, and what trajectories gain in phase they lose in the
/// distribution of energies.
loss_choice usual_loss(const bath& around);

namespace detail {
/// Throws std::invalid_argument unless the name is one line, and no name of losses().
loss_choice own_choice(const std::string& name, int steps, const window_error<lanes>& error);
loss_choice own_choice(const std::string& name, int steps, const window_error<double>& error);
}  // namespace detail

/// A loss of the user's, as a choice. Throws std::invalid_argument unless its name is one line, and no name
/// of losses(); and what own_error() does.
template <SeparableSystem S, class Error>
loss_choice loss_of(const S& system, const own_loss<Error>& own) {
  return detail::own_choice(own.name, own.steps, detail::own_error(system, own.error));
}

/// "state:5", "energy:10", "covariance"; K is 1 where it is not said. Throws std::invalid_argument for
/// anything else.
loss_choice loss_named(std::string_view text);

namespace detail {

/// Parses the name of a loss; empty for other text.
std::optional<loss_choice> find_loss(std::string_view text);

/// The names that loss_named() reads, such as "state:K, energy:K": of the losses that count steps, or of the
/// others.
std::string loss_patterns(bool count_steps);

}  // namespace detail

}  // namespace nysalt
