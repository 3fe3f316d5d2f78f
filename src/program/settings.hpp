// SPDX-License-Identifier: BSL-1.0
// What a command line asks for, as typed: plain values, not yet judged.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../plugin/potential.hpp"

namespace nysalt::program {

class bundled_system;
struct surroundings;

struct common_settings {
  std::uint64_t seed = 1;
  int threads = 1;
  bool json = false;
  bool force = false;
  std::string command;  // the whole command line, for manifests
  std::string options;  // what was asked for by it and by files of options, as TOML
};

/// Of the bath, if there is one: with friction come sigma or temperature.
struct bath_settings {
  std::optional<double> friction;
  std::optional<double> sigma;
  std::optional<double> temperature;
};

struct system_settings {
  std::string name = "fpu";
  /// A system of the caller's own, under that name; empty: one of ours.
  std::function<std::unique_ptr<bundled_system>(const surroundings&)> own = {};
  std::map<std::string, std::string> parameters{};  // by name, as typed
  typed_potential potential{};                      // instead of a name
  std::optional<double> spread;
  bath_settings bath;
  std::string start;  // law, gibbs, trajectory; empty: gibbs if a bath has a temperature, else law
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

struct learn_command {
  system_settings system;
  learn_settings learning;
  /// Which family wins where nothing is known of a system: at equal evaluations, on 16 settings of the eight
  /// bundled systems, its error is 2.0 times that of the best without rotation in the geometric mean, less
  /// than of any other (fg4, fg_chin 2.3; nystrom 160); at equal seconds 1.2 times, and 2.5 times at most. It
  /// asks no derivative of the force.
  std::string family = "bab6";
  std::string placement;
  std::optional<double> step;
  std::vector<double> steps;     // for a curve
  std::optional<double> enough;  // share of the loss: as many trajectories as that takes
  std::string output;
};

struct run_command {
  system_settings system;
  std::string method;
  held_methods held = {};
  std::string placement;
  double step = 0.0;
  double horizon = 0.0;
  std::int64_t trajectories = 1;
  std::vector<std::string> observables;
  std::int64_t sample_every = 1;
  std::string output;
  bool plot = false;
  std::string checkpoint;
  std::optional<std::int64_t> every;  // steps between checkpoints
  bool resume = false;
};

struct compare_command {
  system_settings system;
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
  std::string output;
  bool resume = false;
};

struct recommend_command {
  system_settings system;
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
  std::string output;
};

struct stability_command {
  std::optional<std::string> family;
  std::vector<double> parameters;
  std::optional<std::string> method;
  std::optional<system_settings> system;
  std::optional<double> step;
  std::string output;
  bool plot = false;
};

struct reproduce_command {
  std::vector<std::string> parts;  // of the paper; empty: all
  std::string output;              // a folder
  bool quick = false;
};

struct list_command {
  std::string system;  // the file of one, listed too; empty: none
};

struct build_command {
  std::string source;
  std::string output;  // empty: beside where the program runs
};

struct new_command {
  std::string name;
};

struct cite_command {
  std::vector<std::string> files;
  std::string system;  // empty: not said
  std::vector<std::string> methods;
  std::vector<std::string> metrics;
  bool in_bath = false;
};

}  // namespace nysalt::program
