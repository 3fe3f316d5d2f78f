// SPDX-License-Identifier: BSL-1.0
#include "options_file.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <sstream>

#include "comparison/did_you_mean.hpp"
#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"

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

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// A line without its comment. Throws refusal if a text holds a #, which CLI11 would cut there.
std::string without_comment(const std::string& line, int number) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '#' && quote != 0) refuse("--config, line {}: a text must hold no #, got {}", number, line);
    if (c == '#') return trimmed(line.substr(0, i));
    if (quote == 0 && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    }
  }
  return line;
}

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

/// CLI11 reads a part of TOML, and the rest wrongly without a word. So each line must be empty, a comment, a
/// [section], or name = value with the value whole on that line, and nothing may be said twice. What is
/// handed on has no comments.
std::string plain_toml(std::istream& input) {
  std::string plain;
  std::set<std::string> sections;
  std::set<std::string> names;
  int number = 0;
  std::istringstream lines(bounded(input));
  for (std::string raw; std::getline(lines, raw);) {
    // As long as one argument of a command may be on Linux: CLI11 copies what is left of a list at each
    // value.
    constexpr std::size_t longest = 131072;
    ++number;
    if (raw.size() >= longest)
      refuse("--config, line {}: a line must be shorter than {} bytes, got {}", number, longest, raw.size());
    const std::string line = without_comment(trimmed(raw), number);
    const auto wrong = [&](const char* what, const char* condition) {
      refuse("--config, line {}: {} must {}, got {}", number, what, condition, line);
    };
    plain += line + "\n";
    if (line.empty()) continue;
    if (line.front() == '[') {
      if (line.back() != ']') wrong("a section", "be [NAME] and nothing else on the line");
      if (!sections.insert(line).second) wrong("a section", "not be there twice");
      names.clear();
      continue;
    }
    const auto equals = line.find('=');
    if (equals == std::string::npos) wrong("a line", "be name = value or [section]");
    if (!names.insert(trimmed(line.substr(0, equals))).second) wrong("an option", "not be there twice");
    const std::string value = trimmed(line.substr(equals + 1));
    if (value.empty()) wrong("an option", "have a value");
    const char first = value.front();
    const char last = first == '[' ? ']' : first;
    const bool is_closed = value.size() > 1 && value.back() == last;
    if ((first == '[' || first == '"' || first == '\'') && !is_closed) {
      wrong("a text or list", "end on its line");
    }
  }
  return plain;
}

}  // namespace

std::string system_in_options_file(const std::string& file, const std::string& command) {
  note_input(file);
  std::ifstream input(file);
  if (!input) return {};  // reported where options are read
  std::istringstream text(plain_toml(input));
  std::string of_all;
  for (const auto& item : CLI::ConfigTOML().from_config(text)) {
    if (item.name != "system" || item.inputs.empty()) continue;
    if (item.parents.empty()) of_all = item.inputs.front();
    if (item.parents == std::vector{command}) return item.inputs.front();
  }
  return of_all;
}

std::vector<CLI::ConfigItem> options_file::from_config(std::istream& input) const {
  std::istringstream text(plain_toml(input));
  auto items = CLI::ConfigTOML::from_config(text);
  const auto running = app_.get_subcommands();
  // Of two values for one option the first is taken.
  std::stable_partition(items.begin(), items.end(), [](const auto& item) { return !item.parents.empty(); });
  for (auto& item : items) {
    if (item.parents.empty() && !running.empty()) item.parents = {running.front()->get_name()};
    require_known(item);
  }
  std::erase_if(items, [&](const auto& item) {  // what several commands have would be taken from any section
    return !running.empty() && item.parents.front() != running.front()->get_name();
  });
  return items;
}

/// CLI11 refuses what it does not know too, but does not say what it knows.
void options_file::require_known(const CLI::ConfigItem& item) const {
  if (item.name == "++" || item.name == "--") return;  // a section begins or ends
  const CLI::App* command = &app_;
  for (const auto& section : item.parents) {
    const auto found =
        command->get_subcommands([&](const CLI::App* subcommand) { return subcommand->check_name(section); });
    if (found.empty()) {
      const auto commands = command_names(app_);
      refuse("--config: unknown section '{}': {}", section,
             commands.empty() ? help_of(app_) : did_you_mean(section, commands));
    }
    command = found.front();
  }
  if (const CLI::Option* known = command->get_option_no_throw("--" + item.name)) {
    const bool is_flag = known->get_expected_max() == 0 || known->get_type_size_max() == 0;
    const bool is_switch = item.inputs.size() == 1 && (item.inputs[0] == "true" || item.inputs[0] == "false");
    if (!is_flag || is_switch) return;
    refuse("--config: --{} must be true or false, got {}", item.name, listed(item.inputs));
  }
  refuse("--config: unknown option '{}': {}", item.name,
         did_you_mean(item.name, option_names(*command), help_of(*command)));
}

}  // namespace nysalt::program
