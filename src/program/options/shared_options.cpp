// SPDX-License-Identifier: BSL-1.0
#include "shared_options.hpp"

#include "../bundled_system.hpp"
#include "number_option.hpp"

namespace nysalt::program {

void add_common(CLI::App& command, common_settings& common) {
  add_number(command, "--seed", common.seed, "of all random numbers");
  add_number(command, "--threads", common.threads, "at most so many; results do not depend on it")
      ->default_str("all cores");
  command.add_flag("--json", common.json, "one JSON document on standard output");
  command.fallthrough();  // for --config, which belongs to the program
}

void add_force(CLI::App& command, common_settings& common, const char* what) {
  command.add_flag("--force", common.force, what);
}

void add_system(CLI::App& command, system_settings& system, const char* start) {
  // At once, before an option is missed that follows it: which options there are depends on the system.
  const auto is_known = [](const std::string& name) {
    require_known_system(name);
    return std::string();
  };
  command.add_option("--system", system.name, "nysalt list shows all")
      ->capture_default_str()
      ->check(is_known);
  add_number(command, "--pairs", system.pairs, "fpu: pairs of masses [3]");
  add_number(command, "--omega", system.omega, "fpu, oscillator: stiff frequency [50]");
  add_number(command, "--masses", system.masses, "linear_chain [8], phi4 [16]");
  add_number(command, "--spring", system.spring, "linear_chain [1]");
  add_number(command, "--atoms", system.atoms, "lennard_jones [7]");
  add_number(command, "--space", system.space, "lennard_jones: 2 or 3 dimensions [2]");
  add_number(command, "--friction", system.bath.friction, "of a bath: gamma; with --sigma or --temperature");
  add_number(command, "--sigma", system.bath.sigma, "of its noise");
  add_number(command, "--temperature", system.bath.temperature, "kT = sigma^2/(2 gamma), an energy");
  add_number(command, "--eccentricity", system.eccentricity, "kepler: of the starts [0.6]");
  add_number(command, "--spread", system.spread, "of the law of starts: multiplies its deviations [1]");
  command.add_option("--start", system.start, start);
}

void add_placement(CLI::App& command, std::string& placement) {
  command.add_option("--placement", placement,
                     "of O in a word that has none: end, symmetric or middle [symmetric]");
}

void add_search(CLI::App& command, learn_settings& how, const std::string& prefix) {
  add_number(command, prefix + "trajectories", how.trajectories, "to learn from");
  command.add_option("--coordinates", how.coordinates, "of the loss: qp, modes or energy")
      ->capture_default_str();
  command.add_option("--fix", how.fix, "keep a parameter: b1=0.5");
  command.add_option(prefix + "loss", how.loss, "state:K, energy:K after K steps, or covariance")
      ->capture_default_str();
  add_number(command, prefix + "random-starts", how.random_starts, "of the search, beside the family's own");
}

void add_horizon(CLI::App& command, learn_settings& how, const std::string& prefix) {
  add_number(command, prefix + "horizon", how.horizon,
             "length of each [0.5, or ten steps if that is longer]");
}

void add_learning(CLI::App& command, learn_settings& how, const std::string& prefix) {
  add_number(command, "--fine-step", how.fine_step,
             "of the reference; must divide the step [omega h <= 5e-3]");
  add_horizon(command, how, prefix);
  add_search(command, how, prefix);
}

}  // namespace nysalt::program
