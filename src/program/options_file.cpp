// SPDX-License-Identifier: BSL-1.0
#include "options_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "comparison/did_you_mean.hpp"
#include "comparison/refusal.hpp"
#include "systems.hpp"

namespace nysalt::program {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) names.push_back(option->get_name());
  return names;
}

std::string help_of(const CLI::App& command) {
  const CLI::App* program = command.get_parent();
  return (program == nullptr ? "" : program->get_name() + " ") + command.get_name() +
         " --help lists the options";
}

namespace {

std::string bounded(std::istream& input) {
  constexpr std::size_t most = 1 << 20;  // bytes: files of options are far shorter
  std::string text;
  std::array<char, 4096> block{};
  while (input.read(block.data(), block.size()) || input.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(input.gcount()));
    if (text.size() >= most) refuse("--config: the file must be shorter than a megabyte");
  }
  return text;
}

/// "--config FILE"
std::string named(const std::string& file) { return "--config " + file; }

/// Whether the values of the option are NAME=VALUE, which a table may hold.
bool takes_pairs(const CLI::App& app, const std::string& option) {
  return std::ranges::any_of(app.get_subcommands({}), [&](const CLI::App* command) {
    const CLI::Option* known = command->get_option_no_throw("--" + option);
    return known != nullptr && known->get_type_name().starts_with("NAME=VALUE");
  });
}

}  // namespace

std::vector<CLI::ConfigItem> options_file::from_config(std::istream& input) const {
  const auto who = named(app_.get_option("--config")->as<std::string>());
  const std::string text = bounded(input);
  const auto running = app_.get_subcommands();
  const std::string command = running.empty() ? "" : running.front()->get_name();
  std::vector<CLI::ConfigItem> items;
  const auto all = options_in_toml(text, who, [&](const auto& name) { return takes_pairs(app_, name); });
  for (const auto& option : all) require_no_code(option, command, who);
  for (const auto& option : all) {
    require_known(option, command, fmt::format("{}, line {}", who, option.line));
    const std::string& section = option.section.empty() ? command : option.section;
    // What several commands have would be taken from any section.
    if (option.name.empty() || section != command) continue;
    items.push_back({.parents = {}, .name = option.name, .inputs = option.values});
    if (!command.empty()) items.back().parents = {command};
    // Of two values for one option CLI11 takes the first: that of the section.
    if (!option.section.empty()) std::rotate(items.begin(), items.end() - 1, items.end());
  }
  return items;
}

void options_file::require_no_code(const toml_option& option, const std::string& running,
                                   const std::string& who) const {
  if (option.name != "system" || running.empty()) return;
  if (!option.section.empty() && option.section != running) return;
  const CLI::Option* typed = app_.get_subcommand(running)->get_option_no_throw("--system");
  if (typed != nullptr && typed->count() > 0) return;  // what is typed wins
  for (const std::string& name : option.values) {
    if (!is_path_of_system(name)) continue;
    refuse("{}: a system that is a file must be typed, as its code is run, got '{}'; add --system {}", who,
           name, name);
  }
}

/// CLI11 refuses what it does not know too, but does not say what it knows.
void options_file::require_known(const toml_option& option, const std::string& running,
                                 const std::string& where) const {
  const auto commands = command_names(app_);
  if (!option.section.empty() && std::ranges::count(commands, option.section) == 0) {
    refuse("{}: unknown section '{}': {}", where, option.section,
           commands.empty() ? help_of(app_) : did_you_mean(option.section, commands));
  }
  if (option.name.empty()) return;
  const std::string& name = option.section.empty() ? running : option.section;
  const CLI::App& command = name.empty() ? app_ : *app_.get_subcommand(name);
  const CLI::Option* known = command.get_option_no_throw("--" + option.name);
  if (known == nullptr) {
    refuse("{}: unknown option '{}': {}", where, option.name,
           did_you_mean("--" + option.name, option_names(command), help_of(command)));
  }
  if (option.is_table && !takes_pairs(app_, option.name)) {
    refuse("{}: {} must be a number, a text, true or false, or a list of these, got a table", where,
           option.name);
  }
  const bool is_flag = known->get_expected_max() == 0 || known->get_type_size_max() == 0;
  const bool is_switch =
      option.values.size() == 1 && (option.values[0] == "true" || option.values[0] == "false");
  if (is_flag && !is_switch) {
    refuse("{}: --{} must be true or false, got {}", where, option.name, listed(option.values));
  }
  if (option.values.empty()) refuse("{}: --{} must have a value, got an empty list", where, option.name);
}

std::string options_file::to_config(const CLI::App* app, bool, bool, std::string prefix) const {
  std::string text;
  for (const CLI::Option* option : app->get_options({})) {
    if (!option->get_configurable() || option->count() == 0) continue;
    text += fmt::format("{}{}={}\n", prefix, option->get_single_name(), as_toml(option->reduced_results()));
  }
  for (const CLI::App* command : app->get_subcommands({})) {
    text += to_config(command, false, false, prefix + command->get_name() + ".");
  }
  return text;
}

}  // namespace nysalt::program
