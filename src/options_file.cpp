// SPDX-License-Identifier: BSL-1.0
#include "options_file.hpp"

#include <algorithm>

#include "refusal.hpp"

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

std::vector<CLI::ConfigItem> options_file::from_config(std::istream& input) const {
  auto items = CLI::ConfigTOML::from_config(input);
  const auto running = app_.get_subcommands();
  // Of two values for one option the first is taken.
  std::stable_partition(items.begin(), items.end(), [](const auto& item) { return !item.parents.empty(); });
  for (auto& item : items) {
    if (item.parents.empty() && !running.empty()) item.parents = {running.front()->get_name()};
    require_known(item);
  }
  return items;
}

/// CLI11 refuses what it does not know too, but does not say what it knows.
void options_file::require_known(const CLI::ConfigItem& item) const {
  if (item.name == "++" || item.name == "--") return;  // a section begins or ends
  const CLI::App* command = &app_;
  for (const auto& section : item.parents) {
    const auto found =
        command->get_subcommands([&](const CLI::App* its) { return its->check_name(section); });
    if (found.empty()) {
      refuse("--config: unknown section [{}]: it is one of {}", section, listed(command_names(app_)));
    }
    command = found.front();
  }
  if (command->get_option_no_throw("--" + item.name) != nullptr) return;
  refuse("--config: unknown option '{}': {} takes {}", item.name, command->get_name(),
         listed(option_names(*command)));
}

}  // namespace nysalt::program
