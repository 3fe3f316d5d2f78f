// SPDX-License-Identifier: BSL-1.0
#include "systems.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <new>
#include <sstream>
#include <stdexcept>

#include "../plugin/build.hpp"
#include "../plugin/cache.hpp"
#include "../plugin/plugin.hpp"
#include "bundled_systems.hpp"
#include "comparison/checks.hpp"
#include "comparison/did_you_mean.hpp"
#include "comparison/number.hpp"
#include "comparison/observables.hpp"
#include "comparison/prepared_problem.hpp"
#include "comparison/refusal.hpp"
#include "comparison/user_system_checks.hpp"
#include "given_starts.hpp"
#include "nysalt/core/rounding.hpp"
#include "output/written_arrays.hpp"

namespace nysalt::program {

bool is_file_of_starts(const std::string& start) { return start.ends_with(".csv") || is_of_arrays(start); }

namespace {

bath bath_of(const bath_settings& settings, bool takes_temperature) {
  if (settings.sigma && settings.temperature) {
    refuse_value("sigma", "must come without {}; give one of them (kT = sigma^2/(2 friction))",
                 spelled("temperature"));
  }
  if (!settings.friction) {
    if (settings.sigma) refuse_value("sigma", "must come with {}; give 0 for none", spelled("friction"));
    if (settings.temperature && !takes_temperature)
      refuse_value("temperature", "must come with {}", spelled("friction"));
    return bath::of_sigma(0.0, 0.0);
  }
  if (!settings.sigma && !settings.temperature) {
    refuse_value("friction", "must come with {} or {}; give 0 for damping without noise", spelled("sigma"),
                 spelled("temperature"));
  }
  const auto require = [](const char* field, double value) {
    if (value >= 0.0 && std::isfinite(value)) return;
    refuse_value(field, "must be finite and not negative, got {}", value);
  };
  require("friction", *settings.friction);
  if (settings.temperature) {
    require("temperature", *settings.temperature);
    if (!std::isfinite(2.0 * *settings.friction * *settings.temperature)) {
      refuse("{} and {} must have a finite product, got {} and {}; give smaller ones", spelled("friction"),
             spelled("temperature"), *settings.friction, *settings.temperature);
    }
    return bath::of_temperature(*settings.friction, *settings.temperature);
  }
  require("sigma", *settings.sigma);
  if (*settings.friction > 0.0 &&
      !std::isfinite(*settings.sigma * *settings.sigma / (2.0 * *settings.friction))) {
    refuse("{} and {} must have a finite kT = sigma^2/(2 friction), got {} and {}; give other ones",
           spelled("friction"), spelled("sigma"), *settings.friction, *settings.sigma);
  }
  return bath::of_sigma(*settings.friction, *settings.sigma);
}

double spread_of(const std::optional<double>& asked, start where) {
  if (!asked) return 1.0;
  require_positive("spread", *asked);
  if (where != start::law)
    refuse_value("spread", "must come with {}, which {} scales", spelled("start", "law"), spelled("spread"));
  return *asked;
}

bool gives_states(const system_settings& settings) {
  return !settings.at.empty() || !settings.states.empty();
}

start start_of(const system_settings& settings, const bath& heat_bath) {
  const std::string& asked = settings.start;
  const bool is_warm = heat_bath.acts() && heat_bath.has_temperature() && heat_bath.temperature() > 0.0;
  if (gives_states(settings)) {
    if (asked.empty()) return start::law;
    refuse_value("at", "must come without {}, got {} {}; give one of them", spelled("start"),
                 spelled("start"), asked);
  }
  if (asked.empty()) return is_warm ? start::gibbs : start::law;
  if (asked == "law" || is_file_of_starts(asked)) return start::law;
  if (asked != "gibbs" && asked != "trajectory") {
    refuse("unknown start '{}': {} is one of law, gibbs, trajectory, or a file NAME.csv, NAME.h5 or NAME.npy",
           asked, spelled("start"));
  }
  if (!is_warm) {
    refuse_value("start", "{} must come with a bath of a temperature above 0; give {} and {}", asked,
                 spelled("friction"), spelled("temperature"));
  }
  return asked == "gibbs" ? start::gibbs : start::trajectory;
}

/// What starts in the place of the law, if the user gives it.
std::function<initial_states(const initial_value_problem&)> given_starts_of(const system_settings& settings,
                                                                            const bath& in) {
  const double spread = settings.spread.value_or(0.0);
  const auto coordinates = [settings] {
    return settings.potential.text.empty() ? std::vector<std::string>()
                                           : coordinate_names(settings.potential);
  };
  if (is_file_of_starts(settings.start)) {
    const double usual = in.acts() && in.has_temperature() ? in.temperature() : 1.0;
    const double temperature = settings.bath.temperature.value_or(usual);
    return [=](const initial_value_problem& made) {
      return starts_in(settings.start, made, coordinates(), settings.start_step, temperature, spread);
    };
  }
  if (settings.start_step)
    refuse_value("start_step", "must come with {} FILE, an output of run", spelled("start"));
  if (!settings.states.empty()) {
    return [=](const initial_value_problem& made) { return starts_at(settings.states, made, spread); };
  }
  if (settings.at.empty()) return {};
  return [=](const initial_value_problem& made) {
    given_states states;
    for (const auto& text : settings.at) states.push_back(state_of(text, coordinates(), size(made.system)));
    return starts_at(std::move(states), made, spread);
  };
}

surroundings surroundings_of(const system_settings& settings) {
  const bath heat_bath = bath_of(settings.bath, is_file_of_starts(settings.start));
  const start where = start_of(settings, heat_bath);
  if (settings.frequency) require_positive("frequency", *settings.frequency);
  const double spread = spread_of(settings.spread, where);
  auto starts = given_starts_of(settings, heat_bath);
  const double of_law = starts ? 1.0 : spread;
  return {.bath = heat_bath,
          .start = where,
          .spread = of_law,
          .frequency = settings.frequency,
          .starts = std::move(starts),
          .is_start_usual = settings.start.empty(),
          .examined = settings.examined};
}

/// The typed value of a parameter, as its declaration has it.
parameter_value value_of(const detail::declared_parameter& parameter, const std::string& text) {
  const std::string by = spelled("parameter") + " ";
  const std::string option = by + parameter.name;
  if (parameter.is_text()) return text;
  parameter_value value = parameter.is_whole() ? parameter_value(number_of<std::int64_t>(option, text))
                                               : parameter_value(number_of<double>(option, text));
  try {
    parameter.require(value);
  } catch (const std::invalid_argument& problem) {
    refuse("{}", by + problem.what());
  }
  return value;
}

/// Of parameters, by name.
std::map<std::string, std::string> typed_values(const system_settings& settings) {
  auto all = settings.parameters;
  for (const auto& [name, text] : parameters_of(settings.potential)) {
    if (!all.emplace(name, text).second)
      refuse_value("parameter", "must have different names, got {} twice", name);
  }
  return all;
}

void require_options(const system_settings& settings, const std::map<std::string, std::string>& typed,
                     const system_declaration& declared) {
  std::vector<std::string> takes;
  for (const auto& parameter : declared.parameters) takes.push_back(parameter.name);
  if (declared.has_spread) takes.push_back(spelled("spread"));
  const auto require = [&](const std::string& name) {
    if (std::ranges::find(takes, name) != takes.end()) return;
    const std::string near = nearest_name(name, takes);
    refuse("unknown parameter '{}' of the system {}: {}", name,
           settings.potential.text.empty() ? settings.name : declared.name,
           !near.empty()   ? "did you mean " + near + "?"
           : takes.empty() ? "it takes none"
                           : "it takes " + listed(takes));
  };
  for (const auto& [name, text] : typed) require(name);
  const bool is_given = gives_states(settings) || is_file_of_starts(settings.start);
  if (settings.spread && !is_given) require(spelled("spread"));
}

/// Adds coordinates and momenta by the names of the coordinates to the observables.
void add_named(const std::vector<std::string>& coordinates, initial_value_problem& made) {
  std::vector<initial_value_problem::named_observable> momenta;
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const auto add = [&](std::vector<initial_value_problem::named_observable>& to, const std::string& name,
                         auto value) {
      const bool is_known =
          is_built_in_observable(made, name) || std::ranges::find(coordinates, name) != coordinates.end();
      if (&to == &momenta ? is_known : is_built_in_observable(made, name)) return;
      to.push_back({name, value});
    };
    add(made.observables, coordinates[k], [i](const auto& x) { return x.q[i]; });
    add(momenta, "p" + coordinates[k], [i](const auto& x) { return x.p[i]; });
  }
  for (auto& one : momenta) made.observables.push_back(std::move(one));
}

/// What defines the kind of a system of the user's own: the source, and all parameters but sizes. A
/// library of C functions has one size, so that another size is another source: only nysalt_kind() says of
/// which kind it is.
std::string source_of_kind(const system_declaration& declared, const parameter_values& values) {
  if (declared.identity.empty() || declared.parameters.empty()) return {};
  std::string text = "source " + declared.identity;
  for (const auto& parameter : declared.parameters) {
    if (parameter.is_size || parameter.is_text()) continue;
    text += fmt::format(", {}={}", parameter.name, text_of(values[parameter.name]));
  }
  return text;
}

}  // namespace

const system_declaration& declaration_in(const system_settings& settings) {
  if (settings.declared != nullptr) return *settings.declared;
  const auto& potential = settings.potential;
  if (!potential.text.empty())
    return plugin_at(kept_source(source_of(potential)).string(), spelled("potential"));
  const bool has_more =
      !potential.variables.empty() || !potential.masses.empty() || !potential.around.empty();
  if (has_more)
    refuse("{}, {} and {} must come with {}", spelled("variables"), spelled("mass"), spelled("around"),
           spelled("potential"));
  if (settings.name.empty()) {
    refuse_value(
        "system",
        "must be given; name one that nysalt list shows, or a file of your own, or give a formula as {}",
        spelled("potential"));
  }
  return declaration_of(settings.name);
}

const system_declaration& declaration_of(const std::string& name) {
  if (is_path_of_system(name)) return plugin_at(name);
  std::vector<std::string> names;
  for (const auto& declared : bundled_declarations()) {
    if (declared.name == name) return declared;
    names.push_back(declared.name);
  }
  refuse("unknown system '{}': {}", name, did_you_mean(name, names));
}

bool is_path_of_system(std::string_view name) {
  return name.find('/') != std::string_view::npos || name.ends_with(".so") || name.ends_with(".hpp");
}

std::string text_of(const parameter_value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return text->empty() ? "none" : *text;
  return std::visit([](const auto& known) { return fmt::format("{}", known); }, value);
}

std::string option_of(std::string_view parameter) {
  std::string option = "--" + std::string(parameter);
  std::ranges::replace(option, '_', '-');
  return option;
}

std::string options_of(const system_declaration& system) {
  std::string text;
  for (const auto& parameter : system.parameters) {
    text +=
        fmt::format("{}{}={}", text.empty() ? "--parameter " : ",", parameter.name, text_of(parameter.usual));
  }
  if (system.has_spread) text += text.empty() ? "--spread 1" : " --spread 1";
  return text;
}

std::map<std::string, std::string> files_of(const system_settings& settings) {
  std::map<std::string, std::string> files;
  const auto add = [&](const std::string& name) {
    std::error_code ignored;
    const bool is_file = std::filesystem::is_regular_file(name, ignored);
    std::ostringstream contents;
    if (is_file) contents << std::ifstream(name, std::ios::binary).rdbuf();
    files[name] = is_file ? name_of(contents.view()) : "none";
  };
  if (is_file_of_starts(settings.start)) add(settings.start);
  const system_declaration& declared = declaration_in(settings);
  const auto typed = typed_values(settings);
  for (const auto& parameter : declared.parameters) {
    const auto given = typed.find(parameter.name);
    if (parameter.is_text() && given != typed.end()) add(given->second);
  }
  return files;
}

namespace {

/// Throws refusal where a file of `settings.files` has other contents now.
void require_same_files(const system_settings& settings) {
  if (settings.files.empty()) return;
  const auto now = files_of(settings);
  for (const auto& [name, contents] : settings.files) {
    if (now.at(name) == contents) continue;
    refuse("{}: the file must be as it was when the system was made; make the system again", name);
  }
}

}  // namespace

std::unique_ptr<prepared_problem> make_system(const system_settings& settings) {
  require_same_files(settings);
  surroundings conditions = surroundings_of(settings);
  if (settings.own) return settings.own(conditions);
  const system_declaration& declared = declaration_in(settings);
  conditions.is_bundled = declared.is_checked;
  const auto typed = typed_values(settings);
  require_options(settings, typed, declared);
  parameter_values values;
  std::vector<named_value> named{{"name", declared.name}};
  for (const auto& parameter : declared.parameters) {
    const auto given = typed.find(parameter.name);
    const auto value = given == typed.end() ? parameter.usual : value_of(parameter, given->second);
    values.add(parameter.name, value);
    // A text is how the data are found; what they are, the description says.
    if (parameter.is_text()) continue;
    std::visit([&](const auto& known) { named.push_back({parameter.name, known}); }, value);
  }
  if (!declared.identity.empty()) named.push_back({"source", declared.identity});
  const auto make = [&] { return declared.make(values, conditions.bath, conditions.spread); };
  const std::string source = source_of_kind(declared, values);
  if (declared.is_checked) return std::make_unique<prepared_problem>(make(), named, conditions, source);
  const nysalt::detail::usual_rounding rounding;
  try {
    initial_value_problem made = make();
    examine(made, declared.name, conditions.examined);
    rounding.require();
    if (!settings.potential.text.empty()) add_named(coordinate_names(settings.potential), made);
    return std::make_unique<prepared_problem>(std::move(made), named, conditions, source);
  } catch (const refusal&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& problem) {  // of the user's code
    rounding.require();                      // what else is wrong may come of it
    const std::string text = problem.what();
    if (text.empty())
      refuse("cannot make the system {}: an exception without a message was thrown", declared.name);
    refuse("cannot make the system {}: {}", declared.name, text);
  }
}

}  // namespace nysalt::program
