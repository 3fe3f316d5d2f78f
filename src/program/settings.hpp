// SPDX-License-Identifier: BSL-1.0
// Settings of the command line, as typed: plain values, not yet checked, and the options that hold them.
// `forced` says what --force does; empty: there is none.
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
#include "option_row.hpp"
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

// Rows that several commands have. Those of learning begin with the prefix, "" or "learning.", where a
// command has others of that name; `forced` is empty where there is nothing to force.
option_rows common_rows(common_settings& common, const char* forced, bool has_details = false);
option_rows system_rows(system_settings& system);
option_rows formula_rows(typed_potential& potential);
option_rows start_rows(system_settings& system);
option_rows placement_rows(std::string& placement);
option_rows resume_rows(bool& resume);  // of commands that take long
option_rows learning_rows(learning_options& how, const std::string& prefix);

struct learn_command {
  static constexpr bool has_details = true;  // that --verbose prints
  static constexpr const char* forced = "write the scheme even if the fit is not usable";
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

inline option_rows rows_of(learn_command& asked) {
  option_rows learning = learning_rows(asked.learning, "");
  for (const char* usual : {"fix", "horizon"}) row_of(learning, usual).traits &= ~trait::rare;
  return joined(
      {system_rows(asked.system),
       {{"family", &asked.family, in_method, "the family of methods to learn, a name of nysalt list"},
        {"step", &asked.step, in_method, "the step to learn for, a time"},
        {"steps", &asked.steps, in_method,
         "in place of {step}: several, for a curve of parameters over them"}},
       placement_rows(asked.placement),
       learning,
       {{"enough", &asked.enough, in_learning,
         "in place of {trajectories}: as many as bring their share of the loss below X", 0, "",
         "trajectories"},
        {"output", &asked.output, in_output, "the scheme file to write", trait::program_only, "FILE"}},
       resume_rows(asked.resume)});
}

struct run_command {
  static constexpr const char* forced = "run a scheme at another step or system than it was learned for";
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

inline option_rows rows_of(run_command& asked) {
  return joined(
      {system_rows(asked.system),
       {{"method", &asked.method, in_method,
         "a name of nysalt list, word:LETTERS, or the file of a scheme or table", trait::needed},
        {"step", &asked.step, in_method, "the step of the method, a time", trait::needed},
        {"horizon", &asked.horizon, in_method, "length of each trajectory, a time", trait::needed},
        {"trajectories", &asked.trajectories, in_method,
         "number of trajectories [1, or one for each state that is given]"}},
       placement_rows(asked.placement),
       {{"checks", &asked.checks, in_method, "try neither the step nor a force of your own before the run",
         trait::rare | trait::negated},
        {"observables", &asked.observables, in_output, "the observables to sample [that of the system]"},
        {"sample_every", &asked.sample_every, in_output, "number of steps between two samples"}},
       with({{"output", &asked.output, in_output, "the file to write: CSV, or .h5 or .npy [standard output]",
              0, "FILE"},
             {"plot", &asked.plot, in_output, "draw the first trajectory, in pictures beside the output"},
             {"every", &asked.every, in_output,
              "number of steps after which the state is saved [as often as takes a twentieth of the time]"},
             {"keep_work", &asked.keep_work, in_output,
              "keep the work file in the end: with {resume} a longer {horizon} prolongs the run"}},
            trait::program_only),
       resume_rows(asked.resume)});
}

struct compare_command : comparison_options {
  static constexpr bool has_details = true;  // that --verbose prints
  static constexpr const char* forced = "use a scheme at another step or system than it was learned for";
  system_settings system;
  std::string output;  // a folder
  bool resume = false;
};

inline option_rows rows_of(compare_command& asked) {
  return joined(
      {system_rows(asked.system),
       {{"methods", &asked.methods, in_method,
         "names, word:LETTERS, learned:FAMILY, files; all: those of nysalt list"},
        {"steps", &asked.steps, in_method, "the steps at which each method is measured", trait::needed},
        {"equal_cost", &asked.equal_cost, in_method,
         "steps are per force evaluation: n evaluations make n times the step"},
        {"horizon", &asked.horizon, in_method,
         "length of each trajectory, a time [0.5, or ten of the largest steps if longer]"},
        {"trajectories", &asked.trajectories, in_method, "number of trajectories to measure errors on"}},
       placement_rows(asked.placement),
       {{"prices", &asked.prices, in_method,
         "the prices of the forces of parts 0, 1, ...: an evaluation of a part counts as its share of the "
         "whole force [each kick counts as one]",
         trait::rare},
        {"metrics", &asked.metrics, in_metric,
         "which errors: path (what an observer of the trajectory sees), state, energy, relative, exchange, "
         "acceptance, distribution, acf"},
        {"observable", &asked.observable, in_metric,
         "the observable of path, relative, distribution and acf [that of the system]"},
        {"range", &asked.range, in_metric, "the ends of the histogram of distribution [of the starts]",
         trait::rare, "LOW,HIGH"},
        {"bins", &asked.bins, in_metric, "number of bins of the histogram of distribution", trait::rare},
        {"longest_lag", &asked.longest_lag, in_metric, "the longest lag of the autocovariance acf, a time",
         trait::rare},
        {"hmc_temperature", &asked.hmc_temperature, in_metric, "the temperature kT of acceptance, an energy",
         trait::rare},
        {"levels", &asked.levels, in_metric,
         "errors for which the report says the cost of each method [chosen by the data]", trait::rare}},
       learning_rows(asked.learning, "learning."),
       with(
           {
               {"output", &asked.output, in_output, "a folder to write: the report and its table", 0,
                "FOLDER"},
           },
           trait::program_only),
       resume_rows(asked.resume)});
}

struct recommend_command : recommendation_options {
  static constexpr bool has_details = true;  // that --verbose prints
  static constexpr const char* forced = "";
  system_settings system;
  sampling_options sampling{};  // of the purpose sampling
  std::string output;
  bool resume = false;
};

inline constexpr const char* in_cost = "Cost or error";
inline constexpr const char* in_sampling = "With {purpose} sampling, in place of cost or error";

/// Of both purposes: to find a method for runs, and a word for Hybrid Monte Carlo.
inline option_rows choice_rows(std::int64_t& trajectories, double& hmc_temperature,
                               std::vector<std::string>& families, learning_options& learning) {
  option_rows search = without(learning_rows(learning, "learning."), "fine_step");
  row_of(search, "learning.effort").help =
      "how long to search: quick (as many families are learned), normal or thorough";
  return joined({{{"trajectories", &trajectories, in_cost,
                   "number of trajectories to rank on; the best are measured on as many again"},
                  {"hmc_temperature", &hmc_temperature, in_sampling,
                   "the temperature kT, an energy; that of the metric acceptance too"},
                  {"families", &families, in_method, "the families to learn [all that suit]"}},
                 search});
}

inline option_rows sampling_rows(sampling_options& asked) {
  return {{"length", &asked.length, in_sampling, "mean duration of trajectories, uniform from 0 to twice it"},
          {"acceptance", &asked.acceptance, in_sampling, "the mean acceptance at which steps are compared",
           trait::rare},
          {"times_larger", &asked.times_larger, in_sampling,
           "how many times as large as this system the one is that will be sampled", trait::rare}};
}

inline option_rows rows_of(sampling_options& asked) {
  return joined({sampling_rows(asked),
                 without(choice_rows(asked.trajectories, asked.temperature, asked.families, asked.learning),
                         "purpose")});
}

inline option_rows rows_of(recommend_command& asked) {
  return joined(
      {system_rows(asked.system),
       {{"budget", &asked.budget, in_cost, "force evaluations per unit time that a method may take; or"},
        {"budget_seconds", &asked.budget_seconds, in_cost,
         "seconds per unit time that one trajectory may take on this machine; or"},
        {"error", &asked.error, in_cost, "the error to stay below, at the least cost"},
        {"horizon", &asked.horizon, in_cost, "length of the runs to come, a time"},
        {"metric", &asked.metric, in_cost,
         "the error: state (what is learned for), path, exchange, energy or acceptance"},
        {"observable", &asked.observable, in_cost, "the observable of path [that of the system]",
         trait::rare},
        {"looks", &asked.looks, in_cost,
         "number of observations of each trajectory of the runs to come: processed methods pay for each",
         trait::rare}},
       with(sampling_rows(asked.sampling), trait::program_only),
       choice_rows(asked.trajectories, asked.hmc_temperature, asked.families, asked.learning),
       {{"reversible", &asked.reversible, in_method, "take symmetric methods only"}},
       placement_rows(asked.placement),
       {{"output", &asked.output, in_output, "the file to write: the method to take", trait::program_only,
         "FILE"}},
       resume_rows(asked.resume)});
}

struct stability_command {
  static constexpr bool has_details = true;  // that --verbose prints
  static constexpr const char* forced = "examine a scheme at another step or system than it was learned for";
  std::optional<std::string> family;
  std::vector<double> parameters;
  std::optional<std::string> method;
  std::optional<system_settings> system;
  std::optional<double> step;
  std::string output;
  bool plot = false;
};

inline option_rows rows_of(stability_command& asked) {
  option_rows system = system_rows(asked.system.emplace());
  row_of(system, "system").help = "a system, with {step}: a name of nysalt list, or a file of your own";
  return joined(
      {{{"method", &asked.method, in_method, "a name of nysalt list, or the file of a scheme or table"},
        {"family", &asked.family, in_method, "in place of {method}: a family, with {parameters}"},
        {"parameters", &asked.parameters, in_method, "the values of the parameters of the family"}},
       system,
       {{"step", &asked.step, in_method, "with a system: the step at which the method is judged"},
        {"output", &asked.output, in_output, "a CSV file to write: trace/2 of the step over z", 0, "FILE"},
        {"plot", &asked.plot, in_output,
         "draw this curve beside the output, with its windows and the z of the system"}}});
}

struct sample_command {
  static constexpr const char* forced =
      "sample with a scheme at another step or system than it was learned for";
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

inline option_rows rows_of(sample_command& asked) {
  constexpr const char* in_chains = "Chains";
  return joined(
      {system_rows(asked.system),
       {{"method", &asked.method, in_method,
         "a symmetric method: a name of nysalt list, or the file of a scheme or table"},
        {"step", &asked.step, in_method, "the step of the method; with {acceptance} a first guess"},
        {"acceptance", &asked.acceptance, in_method,
         "the mean acceptance that the burn-in tunes the step to [0.9 without {step}]"},
        {"length", &asked.length, in_method,
         "mean duration of trajectories, uniform from 0 to twice it [pi/2 for {diagonal_masses}]"},
        {"hmc_temperature", &asked.temperature, in_method, "the temperature kT of exp(-V/kT), an energy"},
        {"diagonal_masses", &asked.diagonal_masses, in_method,
         "masses kT/var(q_i), found in the first half of the burn-in"},
        {"chains", &asked.chains, in_chains, "number of independent chains"},
        {"burn_in", &asked.burn_in, in_chains, "trajectories of each chain before its first draw"},
        {"draws", &asked.draws, in_chains, "draws of each chain"},
        {"output", &asked.output, in_output, "a CSV file to write, of all draws", 0, "FILE"},
        {"every", &asked.every, in_output,
         "trajectories of a chain after which the state is saved [as often as takes a twentieth of the "
         "time]"}},
       resume_rows(asked.resume)});
}

struct list_command {
  static constexpr const char* forced = "";
  std::string system;   // the file of one, listed too; empty: none
  std::string schemas;  // the folder for JSON Schema files; empty: none are written
};

inline option_rows rows_of(list_command& asked) {
  return {{"system", &asked.system, in_system, "the file of a system of your own, which is listed too", 0,
           "FILE"},
          {"schemas", &asked.schemas, in_output, "write the JSON Schemas of the documents into the folder", 0,
           "FOLDER"}};
}

struct build_command {
  static constexpr const char* forced = "";
  std::string source;
  std::string output;  // empty: beside where the program runs
};

inline option_rows rows_of(build_command& asked) {
  return {{"SOURCE", &asked.source, "", "the .hpp file that declares the system by NYSALT_SYSTEM",
           trait::positional | trait::needed, "FILE"},
          {"output", &asked.output, in_output, "the library to write [./SOURCE.so]", 0, "FILE"}};
}

struct new_command {
  static constexpr const char* forced = "";
  std::string name;
};

inline option_rows rows_of(new_command& asked) {
  return {{"NAME", &asked.name, "", "the name of the system, whose source NAME.hpp is written here",
           trait::positional | trait::needed}};
}

struct export_command {
  static constexpr const char* forced = "";
  std::string method;
  std::string host;           // empty: by a template
  std::string template_file;  // empty: for a host
  std::string output;         // empty: standard output
  export_request how;
};

inline option_rows rows_of(export_command& asked) {
  return {
      {"METHOD", &asked.method, "", "a name of nysalt list, or the file of a scheme or table",
       trait::positional | trait::needed | trait::program_only},
      {"step", &asked.how.step, in_method,
       "of a scheme over several steps: the step to take, one of them or between them"},
      {"placement", &asked.how.placement, in_method,
       "where letters O of a bath are put into a method without them: end, symmetric or middle [nowhere: no "
       "bath]"},
      {"displaced", &asked.how.displaced, in_method,
       "gradient kicks G become displaced kicks D, which are not symplectic"},
      {"to", &asked.host, in_output, "the language or code to write for", 0, "HOST"},
      {"template", &asked.template_file, in_output,
       "in place of {to}: a template of your own, docs/how-to/export_template.md", 0, "FILE"},
      {"name", &asked.how.name, in_output, "the identifier in the file [the family or method]"},
      {"output", &asked.output, in_output, "the file to write [standard output]", trait::program_only,
       "FILE"}};
}

struct cite_command {
  static constexpr const char* forced = "";
  std::vector<std::string> files;
  std::string system;  // empty: not said
  std::vector<std::string> methods;
  std::vector<std::string> metrics;
  bool in_bath = false;
};

inline option_rows rows_of(cite_command& asked) {
  constexpr const char* in_set_up = "Set-up, in place of files";
  return {
      {"files", &asked.files, "", "scheme files and other results, which say how they were made",
       trait::positional | trait::whole, "FILE"},
      {"system", &asked.system, in_set_up, "the system: a name of nysalt list"},
      {"methods", &asked.methods, in_set_up, "the methods: names of nysalt list, learned:FAMILY, or files"},
      {"metrics", &asked.metrics, in_set_up, "the metrics, as nysalt compare takes them"},
      {"bath", &asked.in_bath, in_set_up, "the system is in a bath"}};
}

}  // namespace nysalt::program
