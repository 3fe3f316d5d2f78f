// SPDX-License-Identifier: BSL-1.0
#include "options_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

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

/// What was read of --config where it is a pipe, which can be read once. Options are read from there, after
/// the system of the options was.
std::optional<std::string> text_of_pipe;

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

/// Names between dots, each of a letter and letters, digits, '-' and '_': CLI11 marks sections by others.
bool is_dotted_name(const std::string& text) {
  bool begins = true;
  for (const char c : text) {
    const auto letter = static_cast<unsigned char>(c);
    if (begins ? std::isalpha(letter) == 0 : std::isalnum(letter) == 0 && c != '-' && c != '_' && c != '.')
      return false;
    begins = c == '.';
  }
  return !begins;
}

/// CLI11 reads a part of TOML, and the rest wrongly without a word. So each line must be empty, a comment, a
/// [section], or name = value with the value whole on that line, and nothing may be said twice. What is
/// handed on has no comments.
std::string plain_toml(const std::string& text) {
  std::string plain;
  std::set<std::string> sections;
  std::set<std::string> names;
  int number = 0;
  std::istringstream lines(text);
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
      if (line.back() == ']' && !is_dotted_name(trimmed(line.substr(1, line.size() - 2))))
        wrong("the name of a section", "begin with a letter, and have letters, digits, '-' and '_' only");
      if (line.back() != ']') wrong("a section", "be [NAME] and nothing else on the line");
      if (!sections.insert(line).second) wrong("a section", "not be there twice");
      names.clear();
      continue;
    }
    const auto equals = line.find('=');
    if (equals == std::string::npos) wrong("a line", "be name = value or [section]");
    if (!is_dotted_name(trimmed(line.substr(0, equals))))
      wrong("the name of an option", "begin with a letter, and have letters, digits, '-' and '_' only");
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
  const std::string all = bounded(input);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) text_of_pipe = all;
  std::istringstream text(plain_toml(all));
  std::string of_all;
  for (const auto& item : CLI::ConfigTOML().from_config(text)) {
    if (item.name != "system" || item.inputs.empty()) continue;
    if (item.parents.empty()) of_all = item.inputs.front();
    if (item.parents == std::vector{command}) return item.inputs.front();
  }
  return of_all;
}

std::vector<CLI::ConfigItem> options_file::from_config(std::istream& input) const {
  std::istringstream text(plain_toml(text_of_pipe ? *std::exchange(text_of_pipe, {}) : bounded(input)));
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
  if (item.name == "++" || item.name == "--") return;  // a section begins or ends
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
