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
  program.set_version_flag("--version", version, "print the version");
  program.formatter(std::make_shared<grouped_help>());
  program.get_help_ptr()->description("print this help");
  program.set_config("--config", "", "a TOML file of options, as typed without the dashes")
      ->type_name(a_file);
  program.config_formatter(std::make_shared<options_file>(program));
  program.allow_config_extras(CLI::config_extras_mode::error);
}

void add_common(CLI::App& command, common_settings& common) {
  begin_group(command, general_options);
  add_number(command, "--seed", common.seed, "the seed of all random numbers");
  add_number(command, "--threads", common.execution.threads,
             "the most threads to use; results do not depend on their number")
      ->default_str("all cores");
  describe_help(command);
  command.fallthrough();  // for --config, which belongs to the program
}

void add_json(CLI::App& command, common_settings& common) {
  command.add_flag("--json", common.json, "print one JSON document and nothing else");
}

void add_resume(CLI::App& command, bool& resume) {
  command.add_flag("--resume", resume, "go on where the work for this output was stopped");
}

void add_verbose(CLI::App& command, common_settings& common) {
  command.add_flag("--verbose", common.verbose, "print all details");
}

void add_force(CLI::App& command, common_settings& common, const char* what) {
  command.add_flag("--force", common.force, what)->group(general_options);
}

namespace {

struct parameter_option {
  std::string name;
  std::string help;
  const char* type;
};

CLI::Option* add_list(CLI::App& command, const std::string& name, std::vector<std::string>& list,
                      const std::string& help) {
  const auto take = [&list](const CLI::results_t& texts) {
    list.clear();
    for (const auto& text : texts) {
      for (const auto& one : split_at_commas(text)) list.push_back(one);
    }
    return true;
  };
  return command.add_option(name, take, help)->expected(1, 1000)->take_all();
}

const char* type_of(const detail::declared_parameter& parameter) {
  return parameter.is_text() ? "TEXT" : parameter.is_whole() ? "N" : "X";
}

/// Of bundled systems; several may have one of the same name: "of linear_chain, its masses [8]; of phi4,
/// ...".
std::vector<parameter_option> parameters_of_systems() {
  std::vector<parameter_option> all;
  for (const system_declaration& system : bundled_declarations()) {
    for (const auto& parameter : system.parameters) {
      const std::string help =
          fmt::format("{}: {} [{}]", system.name, parameter.meaning, text_of(parameter.usual));
      const auto known = std::ranges::find(all, parameter.name, &parameter_option::name);
      if (known == all.end()) {
        all.push_back({parameter.name, help, type_of(parameter)});
      } else {
        known->help += "; " + help;
      }
    }
  }
  return all;
}

CLI::Option* add_parameter(CLI::App& command, system_settings& system, const parameter_option& one) {
  const auto take = [name = one.name, &system](const CLI::results_t& texts) {
    system.parameters[name] = texts.back();
    return true;
  };
  return command.add_option(option_of(one.name), take, one.help)->type_name(one.type);
}

/// "--omega 50" of the bundled systems, which is "--parameter omega=50", and of systems that were loaded.
void add_parameters(CLI::App& command, system_settings& system) {
  std::vector<std::string> added;
  begin_group(command, short_forms);
  for (const auto& one : parameters_of_systems()) {
    add_parameter(command, system, one);
    added.push_back(one.name);
  }
  for (const system_declaration* loaded : loaded_plugins()) {
    begin_group(command, "Parameters of " + loaded->name);
    for (const auto& parameter : loaded->parameters) {
      const std::string help = fmt::format("{} [{}]", parameter.meaning, text_of(parameter.usual));
      if (std::ranges::count(added, parameter.name) == 0) {
        add_parameter(command, system, {parameter.name, help, type_of(parameter)});
        added.push_back(parameter.name);
        continue;
      }
      CLI::Option* option = command.get_option(option_of(parameter.name));
      const bool is_bundled = option->get_group() == short_forms;
      option->description(is_bundled ? help : option->get_description() + "; " + help);
      if (is_bundled) option->group("Parameters of " + loaded->name)->type_name(type_of(parameter));
    }
  }
}

void add_potential(CLI::App& command, typed_potential& potential, CLI::Option* named) {
  command
      .add_option("--potential", potential.text,
                  "in place of --system: V(q) as a formula, such as '0.5*k*(x^2 + y^2)'")
      ->type_name("FORMULA")
      ->excludes(named);
  add_list(command, "--variables", potential.variables,
           "the coordinates of the formula: x,y, or q[16] for sixteen")
      ->type_name(names);
  const auto take_masses = [&masses = potential.masses](const CLI::results_t& texts) {
    masses.clear();
    for (const auto& one : split_at_commas(texts.back())) masses.push_back(number_of<double>("--mass", one));
    return true;
  };
  command
      .add_option("--mass", take_masses, "the masses of the coordinates of the formula: one, or one each [1]")
      ->type_name(numbers);
}

}  // namespace

std::vector<CLI::Option*> add_system(CLI::App& command, system_settings& system) {
  const std::size_t before = command.get_options().size();
  // At once, before an option is missed that follows it: which options there are depends on the system.
  const auto is_known = [](const std::string& name) {
    declaration_of(name);
    return std::string();
  };
  begin_group(command, system_options);
  CLI::Option* named =
      command
          .add_option("--system", system.name,
                      "a name of nysalt list, or a file of your own; it or --potential is required")
          ->type_name(a_name)
          ->check(is_known);
  add_list(command, "--parameter", system.potential.parameters,
           "parameters of the system, as nysalt list shows them: omega=50,pairs=4")
      ->type_name("NAME=VALUE,...");
  add_potential(command, system.potential, named);
  add_number(command, "--friction", system.bath.friction,
             "the friction of a bath that the system is in; --temperature comes with it");
  add_number(command, "--temperature", system.bath.temperature,
             "the temperature kT of the bath, an energy; or --sigma");
  CLI::Option* file =
      command
          .add_option("--start", system.start,
                      "where to start: law (the initial distribution), gibbs, trajectory, or a file")
          ->type_name(a_name);
  command
      .add_option("--at", system.at,
                  "a state to start at: 'x=1,y=0; px=0,py=0.5'; for several give --at again")
      ->type_name("STATE")
      ->expected(1, 1000)
      ->take_all()
      ->excludes(file);

  begin_group(command, more_of(system_options));
  add_list(command, "--around", system.potential.around, "where the starts of the formula are: x=1 [0]")
      ->type_name("NAME=VALUE,...");
  add_number(command, "--spread", system.spread,
             "factor of the standard deviations of the initial distribution [1]");
  add_number(command, "--sigma", system.bath.sigma,
             "the noise of the bath, in place of --temperature, which is sigma^2/(2 friction)");
  add_number(command, "--start-step", system.start_step,
             "of a --start that nysalt run wrote: the step to start at [the last]");
  add_number(
      command, "--frequency", system.frequency,
      "the angular frequency that phase_fitted_... and s_aia... methods are fitted to, and the highest one "
      "where none is known [that which the system declares, or which is seen along the motion]");
  add_parameters(command, system);
  std::vector<CLI::Option*> added = command.get_options([](CLI::Option*) { return true; });
  added.erase(added.begin(), added.begin() + static_cast<std::ptrdiff_t>(before));
  return added;
}

void add_placement(CLI::App& command, std::string& placement) {
  command
      .add_option("--placement", placement,
                  "where letters O of a bath are in a method without them: end, symmetric or middle "
                  "[symmetric]")
      ->type_name(a_name)
      ->group(more_of(method_options));
}

void add_search(CLI::App& command, learning_options& how, const std::string& prefix) {
  begin_group(command, learning_group);
  command
      .add_option("--for", how.purpose, fmt::format("what the runs to come are for: {} [state]", purposes()))
      ->type_name(a_name);
  add_number(command, prefix + "trajectories", how.trajectories, "number of trajectories to learn from");
  command
      .add_option(prefix + "effort", how.effort,
                  "how long to search for parameters: quick, normal or thorough")
      ->type_name(a_name)
      ->capture_default_str();

  begin_group(command, more_of(learning_group));
  command
      .add_option(
          prefix + "loss", how.loss,
          fmt::format("the loss to minimise: {}, or {} after K steps [by --for: state has "
                      "trajectory, in a bath state:1; energy and distribution state:1; sampling acceptance]",
                      detail::loss_patterns(false), detail::loss_patterns(true)))
      ->type_name(a_name);
  command
      .add_option("--coordinates", how.coordinates,
                  "the coordinates in which the loss measures a state: qp, modes or energy [energy for the "
                  "loss trajectory of a system with modes, else qp]")
      ->type_name(a_name);
  command
      .add_option("--fix", how.fix,
                  "a parameter of the family that is not learned but has this value: b1=0.5")
      ->type_name("NAME=VALUE");
  add_number(command, prefix + "random-starts", how.random_starts,
             "number of random parameters that the search begins from, beside those of the family [by the "
             "effort]");
}

void add_horizon(CLI::App& command, learning_options& how, const std::string& prefix) {
  add_number(command, prefix + "horizon", how.horizon,
             "length of the trajectories to learn from, a time [200 steps; of losses after K steps 0.5, or "
             "ten steps if that is longer]")
      ->group(more_of(learning_group));
}

void add_learning(CLI::App& command, learning_options& how, const std::string& prefix) {
  add_search(command, how, prefix);
  add_horizon(command, how, prefix);
  add_number(command, "--fine-step", how.fine_step,
             "the fine step of the reference, which must divide the step [omega h <= 5e-3]")
      ->group(more_of(learning_group));
}

}  // namespace nysalt::program
