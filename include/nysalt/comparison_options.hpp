// SPDX-License-Identifier: BSL-1.0
// Options of learning, comparing and recommending: plain values, checked when they are used.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/execution.hpp"

namespace nysalt {

/// Options of all computations.
struct common_options {
  std::uint64_t seed = 1;  ///< below 2^51: learning, judging and testing draw apart from each other by it
  bool force = false;      ///< whether a scheme may be used at another step or system than in learning
  nysalt::execution execution{};  ///< the number of threads; progress_of_parts is called in place of progress
  /// Callback with the name of the current part and its completed share, from any thread, one call at a time.
  /// An exception that it throws cancels the work. Empty: progress is written to standard error, on a
  /// terminal as one line, and elsewhere once a minute.
  std::function<void(const std::string& part, double share)> progress_of_parts = {};
};

/// Options of learning at a step that is given elsewhere.
struct learning_options {
  /// Purpose of the runs to come, which sets the loss where none is named: state (the state along
  /// trajectories), energy (energies, which errors of the phase do not change), distribution (of long runs),
  /// or sampling (proposals of Hybrid Monte Carlo). Empty: state, and sampling in sampling_options.
  std::string purpose{};
  std::optional<double>
      fine_step{};  ///< fine step of the reference; must divide the step. None: by the frequency
  std::int64_t trajectories = 100;  ///< trajectories to learn from, and as many to judge by
  std::optional<double> horizon{};  ///< horizon of each trajectory. None: see horizon_at()
  std::string coordinates{};  ///< coordinates of the errors: qp, modes or energy. Empty: as suits the loss
  std::vector<std::string> fix{};  ///< parameters of the family that are not learned: "name=value"
  std::string loss{};  ///< as of loss_named(). Empty: by the purpose. Of state trajectory, in a bath state:1;
                       ///< of energy and distribution state:1; of sampling acceptance
  std::string effort = "normal";  ///< effort of the search by trajectories: quick, normal or thorough
  std::optional<std::int64_t> random_starts{};  ///< random starts of the search. None: by the effort

  /// The horizon at a step. Where none is asked for it is 200 steps; of losses after K steps it is 0.5, or
  /// ten steps if that is longer.
  double horizon_at(double step) const;
};

/// Methods, trajectories and error measures of a comparison.
struct comparison_options {
  /// Names, "learned:FAMILY", paths of files, or names of `held`; "all" stands for each method of the
  /// program's list that applies to the system, its bath and the metrics.
  std::vector<std::string> methods{"all"};
  std::vector<double> steps{};  ///< sizes: of a whole step, or (equal_cost) of a force evaluation
  bool equal_cost =
      false;  ///< whether steps are per force evaluation, so that rows of one step have equal cost
  /// The price of the force of each part of a sum, in any unit: evaluations are then evaluations of the whole
  /// force, and a kick with a part counts as the share of the part. Empty: each kick counts as one.
  std::vector<double> prices{};
  std::optional<double> horizon{};  ///< horizon of each trajectory. None: 0.5, or ten of the largest steps
  std::int64_t trajectories = 400;  ///< trajectories to compare on; none of them is learned from
  std::vector<std::string> metrics{"path"};  ///< path, relative, state, exchange, energy, acceptance,
                                             ///< distribution, acf; path:OBSERVABLE is the path error of one
  std::string observable{};     ///< observable of path, relative, distribution and acf. Empty: the usual
  learning_options learning{};  ///< options of learned methods
  /// Schemes and tables that the caller holds in memory: by name the text of what would be their file.
  std::map<std::string, std::string> held{};
  std::string placement{};       ///< placement of the letters O in a bath: end, symmetric or middle
  std::vector<double> levels{};  ///< errors at which costs are compared; empty: taken from the data
  std::vector<double> range{};   ///< low and high end of the histogram; empty: the range of the starts
  std::int64_t bins = 100;       ///< bins of the histogram
  double longest_lag = 1.0;      ///< longest lag of the autocovariance, a time
  double hmc_temperature = 1.0;  ///< kT of the acceptance, an energy
  bool energies = false;         ///< errors of the energy are followed along the horizon, for a picture
};

/// Among which methods one is chosen: at a cost, or at an error.
struct recommendation_options {
  std::optional<double> budget{};                ///< force evaluations per unit time; or
  std::optional<double> budget_seconds{};        ///< seconds per unit time of one trajectory; or
  std::optional<double> error{};                 ///< an error by the metric
  double horizon = 0.0;                          ///< horizon of each trajectory, positive
  std::string metric = "state";                  ///< metric, as in comparison_options
  std::string observable{};                      ///< observable of path and relative. Empty: the usual
  std::int64_t trajectories = 100;               ///< trajectories to rank by
  std::vector<std::string> families{};           ///< families that may be learned. Empty: all that suit
  learning_options learning{.effort = "quick"};  ///< options of the families that are learned
  std::string placement{};       ///< placement of the letters O in a bath: end, symmetric or middle
  double hmc_temperature = 1.0;  ///< kT of the acceptance, an energy
  bool reversible = false;       ///< symmetric methods only
  std::int64_t looks = 1;  ///< observations of each trajectory of later runs: processed methods pay for each
};

/// Options of the choice of word and step of Hybrid Monte Carlo for a system: at one acceptance, all words
/// with the same durations of trajectories.
struct sampling_options {
  double length = 0.0;              ///< mean duration of a trajectory: durations are uniform up to twice that
  double acceptance = 0.9;          ///< acceptance probability at which the steps of words are compared
  double temperature = 1.0;         ///< kT, an energy: exp(-V/kT) is sampled
  double times_larger = 1.0;        ///< size of the system that will be sampled, as a multiple of this one:
                                    ///< energy errors add up, so that a small lattice predicts a large one
  std::int64_t trajectories = 100;  ///< trajectories to judge words by
  std::vector<std::string> families{};           ///< families to learn. Empty: bab3 to bab6, and fd_chin
  learning_options learning{.effort = "quick"};  ///< options of the families that are learned; their horizon
                                                 ///< is twice the length where none is named
  bool starts_are_thermal = false;  ///< starts are draws of exp(-H/kT); else pilot chains make some from them
};

}  // namespace nysalt
