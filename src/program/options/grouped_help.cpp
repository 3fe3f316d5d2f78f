// SPDX-License-Identifier: BSL-1.0
#include "grouped_help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace nysalt::program {

namespace {

constexpr std::size_t columns = 110;
constexpr std::size_t columns_of_names = 32;
constexpr const char* more = ", more";

bool is_of_few(const std::string& group) { return group.ends_with(more) || group == short_forms; }

/// In lines of that many columns, broken at blanks.
std::string broken(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string lines;
  std::size_t length = 0;  // of the last line
  for (std::string word; words >> word;) {
    const bool fits = length + 1 + word.size() <= width;
    if (length > 0) lines += fits ? ' ' : '\n';
    length = length > 0 && fits ? length + 1 + word.size() : word.size();
    lines += word;
  }
  return lines;
}

/// "nysalt learn --help-all shows 31 more options.", if there are some.
std::string line_of_more(const CLI::App& command) {
  const auto left_out =
      command.get_options([](const CLI::Option* option) { return is_of_few(option->get_group()); }).size();
  if (left_out == 0) return {};
  return fmt::format("\n{} {} --help-all shows {} more options.\n", command.get_parent()->get_name(),
                     command.get_name(), left_out);
}

}  // namespace

void begin_group(CLI::App& command, const std::string& group) { command.option_defaults()->group(group); }

std::string more_of(const std::string& group) { return group + more; }

void describe_help(CLI::App& command) {
  if (command.get_parent() == nullptr) return;  // a program without commands
  const auto describe = [&](const char* name, const char* what) {
    CLI::Option* option = command.get_option_no_throw(name);
    if (option != nullptr) option->group(in_general)->description(what);
  };
  describe("--help", "print the options that most runs need");
  describe("--help-all", "print all options");
}

grouped_help::grouped_help() { column_width(columns_of_names); }

std::string grouped_help::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  if (mode == CLI::AppFormatMode::Sub) return make_expanded(app);
  return make_description(app) + make_usage(app, name) + make_positionals(app) + groups_of(*app, mode) +
         make_subcommands(app, mode) + (mode == CLI::AppFormatMode::Normal ? line_of_more(*app) : "") + '\n' +
         make_footer(app);
}

std::string grouped_help::groups_of(const CLI::App& app, CLI::AppFormatMode mode) const {
  auto groups = app.get_groups();
  std::erase_if(groups, [&](const std::string& group) {
    return group.empty() || (mode == CLI::AppFormatMode::Normal && is_of_few(group));
  });
  std::ranges::stable_sort(groups, {}, [](const std::string& group) {
    return group == in_general ? 2 : is_of_few(group) ? 1 : 0;
  });
  std::string all;
  for (const auto& group : groups) {
    const auto options = app.get_options(
        [&](const CLI::Option* option) { return option->get_group() == group && option->nonpositional(); });
    if (!options.empty()) all += make_group(group, false, options);
  }
  return all;
}

std::string grouped_help::make_option(const CLI::Option* option, bool is_positional) const {
  std::ostringstream text;
  const std::string name =
      make_option_name(option, is_positional) + (is_positional ? "" : make_option_opts(option));
  CLI::detail::format_help(text, name, broken(make_option_desc(option), columns - columns_of_names),
                           columns_of_names);
  return text.str();
}

std::string grouped_help::make_option_opts(const CLI::Option* option) const {
  if (option->get_type_size() == 0) return {};  // a flag
  std::string text = " " + option->get_type_name();
  if (!option->get_default_str().empty()) text += " [" + option->get_default_str() + "]";
  if (option->get_required()) text += " REQUIRED";
  return text;
}

}  // namespace nysalt::program
