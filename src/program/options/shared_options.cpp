// SPDX-License-Identifier: BSL-1.0
#include "shared_options.hpp"
#include "program/systems.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <type_traits>
#include <vector>

#include "../../plugin/plugin.hpp"
#include "../bundled_systems.hpp"
#include "../comma_list.hpp"
#include "../options_file.hpp"
#include "comparison/number.hpp"
#include "comparison/spelling.hpp"
#include "nysalt/version.hpp"

namespace nysalt::program {

namespace {

constexpr spelling in_options{.prefix = "--",
                              .between_words = '-',
                              .learning = "learn_",
                              .renamed = [](std::string_view field) -> std::string_view {
                                return field == "purpose" ? "for" : field == "metrics" ? "metric" : field;
                              },
                              .equals = " ",
                              .switched_on = "",
                              .quote = "",
                              .separator = " ",
                              .learn = "nysalt learn --system SYSTEM ",
                              .learned = " --output scheme.json"};

/// Read here, as CLI11 takes an empty text for 0, 010 for 8, and a number that is too large for the largest.
template <class T>
void read_into(const std::string& name, const CLI::results_t& texts, T& to) {
  to = number_of<T>(name, texts.back());
}
template <class T>
void read_into(const std::string& name, const CLI::results_t& texts, std::optional<T>& to) {
  to = number_of<T>(name, texts.back());
}
void read_into(const std::string& name, const CLI::results_t& texts, std::vector<double>& to) {
  to = numbers_of(texts, name.c_str());
}
void read_into(const std::string& name, const CLI::results_t& texts, std::vector<std::string>& to) {
  to = entries_of(texts, name.c_str());
}

template <class T>
constexpr bool is_list = false;
template <class T>
constexpr bool is_list<std::vector<T>> = true;
template <class T>
constexpr bool is_text = std::is_same_v<T, std::string> || std::is_same_v<T, std::optional<std::string>>;

template <class T>
const char* type_of() {
  if (is_text<T>) return "NAME";
  if (std::is_same_v<T, std::vector<std::string>>) return "NAME,...";
  if (std::is_same_v<T, std::vector<double>>) return "X,...";
  return std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>> ? "X" : "N";
}

std::string shown(const auto& value) { return fmt::format("{}", value); }
template <class T>
std::string shown(const std::optional<T>& value) {
  return shown(*value);
}
template <class T>
std::string shown(const std::vector<T>& values) {
  return fmt::format("{}", fmt::join(values, ","));
}

template <class T>
CLI::Option* add_read(CLI::App& command, const std::string& name, T& to) {
  const auto take = [name, &to](const CLI::results_t& texts) {
    read_into(name, texts, to);
    return true;
  };
  CLI::Option* option = command.add_option(name, CLI::callback_t(take));
  return is_list<T> ? option->expected(1, CLI::detail::expected_max_vector_size)->take_all() : option;
}

template <class T>
CLI::Option* add_option(CLI::App& command, const option_row& row, const std::string& name, T& to) {
  CLI::Option* option = nullptr;
  if constexpr (is_text<T>) {
    option = command.add_option(name, to);
  } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    option = row.is(trait::whole) ? command.add_option(name, to) : add_read(command, name, to);
  } else {
    option = add_read(command, name, to);
  }
  if (to != T{} && !row.is(trait::machine)) option->default_str(shown(to));
  if (!row.is(trait::positional) || !row.takes.empty())
    option->type_name(row.takes.empty() ? type_of<T>() : row.takes);
  return option;
}

CLI::Option* add_option(CLI::App& command, const option_row& row, const std::string& name, bool& to) {
  const bool then = !row.is(trait::negated);
  return command.add_flag_function(name, [&to, then](std::int64_t times) { to = (times > 0) == then; });
}

struct parameter_option {
  std::string name;
  std::string help;
  const char* type;
};

const char* type_name_of(const detail::declared_parameter& parameter) {
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
        all.push_back({parameter.name, help, type_name_of(parameter)});
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

}  // namespace

void spell_as_options() { spell(in_options); }

void add_of_program(CLI::App& program) {
  spell_as_options();
  program.set_version_flag("--version", version, "print the version");
  program.formatter(std::make_shared<grouped_help>());
  program.get_help_ptr()->description("print this help");
  program.set_config("--config", "", "a TOML file of options, as typed without the dashes")
      ->type_name("FILE");
  program.config_formatter(std::make_shared<options_file>(program));
  program.allow_config_extras(CLI::config_extras_mode::error);
}

void add_options(CLI::App& command, const option_rows& rows) {
  for (const auto& row : rows) {
    const std::string name =
        row.is(trait::positional) ? row.field : spelled((row.is(trait::negated) ? "no_" : "") + row.field);
    CLI::Option* option = std::visit([&](auto* to) { return add_option(command, row, name, *to); }, row.to);
    const std::string group = spelled_in(row.group);
    option->description(spelled_in(row.help));
    if (!group.empty()) option->group(row.is(trait::rare) ? more_of(group) : group);
    option->required(row.is(trait::needed));
    if (!row.excludes.empty()) option->excludes(command.get_option(spelled(row.excludes)));
  }
}

void add_common(CLI::App& command, common_settings& common, const char* forced, bool has_details) {
  add_options(command, common_rows(common, forced, has_details));
  describe_help(command);
  command.fallthrough();  // for --config, which belongs to the program
}

void add_parameters(CLI::App& command, system_settings& system) {
  // At once, before an option is missed that follows it: which options there are depends on the system.
  command.get_option("--system")->check([](const std::string& name) {
    declaration_of(name);
    return std::string();
  });
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
        add_parameter(command, system, {parameter.name, help, type_name_of(parameter)});
        added.push_back(parameter.name);
        continue;
      }
      CLI::Option* option = command.get_option(option_of(parameter.name));
      const bool is_bundled = option->get_group() == short_forms;
      option->description(is_bundled ? help : option->get_description() + "; " + help);
      if (is_bundled) option->group("Parameters of " + loaded->name)->type_name(type_name_of(parameter));
    }
  }
}

}  // namespace nysalt::program
