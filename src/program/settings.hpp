// SPDX-License-Identifier: BSL-1.0
// Settings of the command line, as typed: plain values, not yet checked.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comparison/examination.hpp"
#include "comparison/exported_source.hpp"
#include "comparison/settings.hpp"
#include "given_starts.hpp"
#include "plugin/potential.hpp"

namespace nysalt {
struct system_declaration;
}

namespace nysalt::program {

class prepared_problem;
struct surroundings;

/// Of the bath, if there is one: with friction come sigma or temperature.
struct bath_settings {
  std::optional<double> friction;
  std::optional<double> sigma;
  std::optional<double> temperature;
};

struct system_settings {
  std::string name;                              // empty: of the potential, or not said
  const system_declaration* declared = nullptr;  // of the name or the potential, where it is known already
  /// A system of the caller's own, under that name; empty: one of ours.
  std::function<std::unique_ptr<prepared_problem>(const surroundings&)> own = {};
  std::map<std::string, std::string> parameters{};  // by name, as typed
  typed_potential potential{};  // instead of a name; its parameters are those of a named system, too
  std::optional<double> spread;
  std::optional<double> frequency;  // to which methods are fitted
  bath_settings bath;
  std::string start;  // law, gibbs, trajectory, or a file; empty: gibbs if a bath has a temperature, else law
  std::vector<std::string> at;             // states to begin at, as typed: x=1,y=0;px=0,py=0.5
  std::optional<std::int64_t> start_step;  // of the file
  given_states states{};                   // of the caller's own, to begin at
  examination examined = examination::whole;
  /// Files that the system was made of, with names of their contents: they must be the same whenever it is
  /// made.
  std::map<std::string, std::string> files{};
};

struct learn_command {
  system_settings system;
  learning_options learning;
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
  bool resume = false;
};

struct run_command {
  system_settings system;
  std::string method;
  std::map<std::string, std::string> held = {};
  std::string placement;
  double step = 0.0;
  double horizon = 0.0;
  std::optional<std::int64_t> trajectories;  // nothing: one for each state that is given, or one
  std::vector<std::string> observables;
  std::int64_t sample_every = 1;
  std::string output;
  bool plot = false;
  std::optional<std::int64_t> every;  // steps between states that are saved; nothing: as time allows
  bool resume = false;
  bool keep_work = false;  // so that the finished run can be prolonged
  bool checks = true;      // of the system and of the step
};

struct compare_command : comparison_options {
  system_settings system;
  std::string output;  // a folder
  bool resume = false;
};

struct recommend_command : recommendation_options {
  system_settings system;
  sampling_options sampling{};  // of the purpose sampling
  std::string output;
  bool resume = false;
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

struct sample_command {
  system_settings system;
  std::string method = "bcss3";
  std::optional<double> step;        // kept, unless an acceptance is asked for
  std::optional<double> acceptance;  // to which the step is tuned
  std::optional<double> length;
  double temperature = 1.0;
  std::int64_t chains = 4;
  std::int64_t burn_in = 1000;
  std::int64_t draws = 1000;
  bool diagonal_masses = false;
  std::string output;
  std::optional<std::int64_t> every;  // trajectories between states that are saved; nothing: as time allows
  bool resume = false;
};

struct list_command {
  std::string system;   // the file of one, listed too; empty: none
  std::string schemas;  // the folder for JSON Schema files; empty: none are written
};

struct build_command {
  std::string source;
  std::string output;  // empty: beside where the program runs
};

struct new_command {
  std::string name;
};

struct export_command {
  std::string method;
  std::string host;           // empty: by a template
  std::string template_file;  // empty: for a host
  std::string output;         // empty: standard output
  export_request how;
};

struct cite_command {
  std::vector<std::string> files;
  std::string system;  // empty: not said
  std::vector<std::string> methods;
  std::vector<std::string> metrics;
  bool in_bath = false;
};

}  // namespace nysalt::program
