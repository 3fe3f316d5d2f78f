// SPDX-License-Identifier: BSL-1.0
// How to learn, to compare and to recommend: plain values, not yet judged.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace nysalt::program {

struct common_settings {
  std::uint64_t seed = 1;
  int threads = 1;
  bool json = false;
  bool force = false;
  std::string command;  // the whole command line, for manifests
  std::string options;  // what was asked for by it and by files of options, as TOML
};

/// How to learn; the step comes from elsewhere.
struct learn_settings {
  std::optional<double> fine_step;
  std::int64_t trajectories = 100;
  std::optional<double> horizon;  // of each trajectory
  std::string coordinates = "qp";
  std::vector<std::string> fix;  // name=value
  std::string loss = "state";
  std::int64_t random_starts = 0;

  /// Where none is asked for: 0.5, or ten steps if that is longer, so that there are pairs to learn from.
  double horizon_at(double step) const { return horizon.value_or(std::max(0.5, 10.0 * step)); }
};

/// Schemes and tables that a caller holds in memory: by name the text of what would be their file.
using held_methods = std::map<std::string, std::string>;

struct comparison_options {
  learn_settings learning;
  std::vector<std::string> methods;
  held_methods held = {};
  std::string placement;
  std::vector<double> steps;
  bool equal_cost = false;
  std::optional<double> horizon;  // none: 0.5, or ten of the largest steps if that is longer
  std::int64_t trajectories = 400;
  std::vector<std::string> metrics{"path"};
  std::string observable;
  std::vector<double> levels;  // of errors, at which costs are compared; empty: those of the data
  std::vector<double> range;   // of the histogram; empty: that of the starts
  std::int64_t bins = 100;
  double longest_lag = 1.0;      // of the autocovariance, a time
  double hmc_temperature = 1.0;  // kT of the acceptance
  bool energies = false;         // followed along the horizon, for their picture
};

struct recommendation_options {
  learn_settings learning;
  std::vector<std::string> families;  // empty: all that suit
  std::string placement;
  std::optional<double> budget;          // evaluations per unit time
  std::optional<double> budget_seconds;  // per unit time of one trajectory
  std::optional<double> error;
  double horizon = 0.0;
  std::int64_t trajectories = 100;
  std::string metric = "state";
  std::string observable;
  double hmc_temperature = 1.0;
  bool reversible = false;
};

}  // namespace nysalt::program
