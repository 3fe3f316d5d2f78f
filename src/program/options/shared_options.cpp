// SPDX-License-Identifier: BSL-1.0
#include "shared_options.hpp"
#include "program/systems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "../../plugin/plugin.hpp"
#include "../bundled_systems.hpp"
#include "../comma_list.hpp"
#include "../options_file.hpp"
#include "comparison/number.hpp"
#include "comparison/purpose.hpp"
#include "number_option.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/version.hpp"

namespace nysalt::program {

void add_of_program(CLI::App& program) {
  program.set_version_flag("--version", version);
  program.get_formatter()->column_width(34);
  program.set_config("--config", "", "TOML file of options, as typed without the dashes");
  program.config_formatter(std::make_shared<options_file>(program));
  program.allow_config_extras(CLI::config_extras_mode::error);
}

void add_common(CLI::App& command, common_settings& common) {
  add_number(command, "--seed", common.seed, "of all random numbers");
  add_number(command, "--threads", common.execution.threads, "at most N threads; results do not depend on it")
      ->default_str("all cores");
  command.add_flag("--json", common.json, "one JSON document on standard output");
  command.fallthrough();  // for --config, which belongs to the program
}

void add_force(CLI::App& command, common_settings& common, const char* what) {
  command.add_flag("--force", common.force, what);
}

namespace {

struct parameter_option {
  std::string name;
  std::string help;
  const char* type;
};

void add_list(CLI::App& command, const std::string& name, std::vector<std::string>& list,
              const std::string& help) {
  const auto take = [&list](const CLI::results_t& texts) {
    list.clear();
    for (const auto& text : texts) {
      for (const auto& one : split_at_commas(text)) list.push_back(one);
    }
    return true;
  };
  command.add_option(name, take, help)->type_name("TEXT")->expected(1, 1000)->take_all();
}

/// Of all systems; several may have one of the same name: "linear_chain, phi4: of the chain [8], of the ring
/// [16]".
std::vector<parameter_option> parameters_of_systems() {
  std::vector<parameter_option> all;
  const auto add = [&](const system_declaration& system) {
    for (const auto& parameter : system.parameters) {
      const std::string help =
          fmt::format("{}: {} [{}]", system.name, parameter.meaning, text_of(parameter.usual));
      const auto known = std::ranges::find(all, parameter.name, &parameter_option::name);
      if (known == all.end()) {
        const char* type = parameter.is_text() ? "TEXT" : parameter.is_whole() ? "INTEGER" : "NUMBER";
        all.push_back({parameter.name, help, type});
      } else {
        known->help += "; " + help;
      }
    }
  };
  for (const auto& system : bundled_declarations()) add(system);
  for (const system_declaration* system : loaded_plugins()) add(*system);
  return all;
}

}  // namespace

std::vector<CLI::Option*> add_system(CLI::App& command, system_settings& system, const char* start) {
  const std::size_t before = command.get_options().size();
  // At once, before an option is missed that follows it: which options there are depends on the system.
  const auto is_known = [](const std::string& name) {
    declaration_of(name);
    return std::string();
  };
  CLI::Option* named =
      command.add_option("--system", system.name, "a name that nysalt list shows, or the file of your own")
          ->capture_default_str()
          ->check(is_known);
  command.add_option("--potential", system.potential.text, "instead: V as text, such as 0.5*k*(x^2 + y^2)")
      ->excludes(named);
  add_list(command, "--variables", system.potential.variables,
           "of the potential: its coordinates, x,y or q[16]");
  add_list(command, "--parameter", system.potential.parameters, "of the potential: k=400,l=2");
  add_list(command, "--around", system.potential.around, "where its starts are: x=1 [0]");
  const auto take_masses = [&masses = system.potential.masses](const CLI::results_t& texts) {
    masses.clear();
    for (const auto& one : split_at_commas(texts.back())) masses.push_back(number_of<double>("--mass", one));
    return true;
  };
  command.add_option("--mass", take_masses, "of its coordinates: one, or one for each [1]")
      ->type_name("NUMBERS");
  for (const auto& [name, help, type] : parameters_of_systems()) {
    const auto take = [name = name, &system](const CLI::results_t& texts) {
      system.parameters[name] = texts.back();
      return true;
    };
    command.add_option("--" + name, take, help)->type_name(type);
  }
  add_number(command, "--friction", system.bath.friction, "of a bath: gamma; with --sigma or --temperature");
  add_number(command, "--sigma", system.bath.sigma, "of its noise");
  add_number(command, "--temperature", system.bath.temperature, "kT = sigma^2/(2 gamma), an energy");
  add_number(command, "--spread", system.spread,
             "multiplies the standard deviations of the initial distribution [1]");
  add_number(
      command, "--frequency", system.frequency,
      "angular frequency that phase_fitted_... and s_aia... are fitted to, and the highest one where none "
      "is known [declared, or seen along the motion]");
  CLI::Option* file = command.add_option("--start", system.start, start);
  command
      .add_option("--at", system.at,
                  "a state to begin at, 'x=1,y=0; px=0,py=0.5', 0 where nothing is said; several: --at again")
      ->type_name("TEXT")
      ->expected(1, 1000)
      ->take_all()
      ->excludes(file);
  add_number(command, "--start-step", system.start_step,
             "of a --start that run wrote: the step to begin at [the last]");
  std::vector<CLI::Option*> added = command.get_options([](CLI::Option*) { return true; });
  added.erase(added.begin(), added.begin() + static_cast<std::ptrdiff_t>(before));
  return added;
}

void add_placement(CLI::App& command, std::string& placement) {
  command.add_option("--placement", placement,
                     "of O in a word that has none: end, symmetric or middle [symmetric]");
}

void add_search(CLI::App& command, learning_options& how, const std::string& prefix) {
  command.add_option("--for", how.purpose,
                     fmt::format("{}: what the runs are for, which sets the loss [state]", purposes()));
  add_number(command, prefix + "trajectories", how.trajectories, "to learn from");
  command.add_option(
      "--coordinates", how.coordinates,
      "of the loss: qp, modes or energy [energy for trajectory where there are modes, else qp]");
  command.add_option("--fix", how.fix, "keep a parameter: b1=0.5");
  command.add_option(
      prefix + "loss", how.loss,
      fmt::format("{}, or {} after K steps [by the purpose: trajectory, and state:1 in a bath; state:1; "
                  "state:1; acceptance]",
                  detail::loss_patterns(false), detail::loss_patterns(true)));
  command
      .add_option(prefix + "effort", how.effort, "of the search by trajectories: quick, normal or thorough")
      ->capture_default_str();
  add_number(command, prefix + "random-starts", how.random_starts,
             "of the search, beside the family's own [by the effort]");
}

void add_horizon(CLI::App& command, learning_options& how, const std::string& prefix) {
  add_number(command, prefix + "horizon", how.horizon,
             "length of each [200 steps; of losses after K steps 0.5 or ten steps]");
}

void add_learning(CLI::App& command, learning_options& how, const std::string& prefix) {
  add_number(command, "--fine-step", how.fine_step,
             "of the reference; must divide the step [omega h <= 5e-3]");
  add_horizon(command, how, prefix);
  add_search(command, how, prefix);
}

}  // namespace nysalt::program
