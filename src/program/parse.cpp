// SPDX-License-Identifier: BSL-1.0
#include "parse.hpp"

#include <algorithm>

#include "comparison/did_you_mean.hpp"
#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/version.hpp"
#include "options_file.hpp"

namespace nysalt::program {

namespace {

/// A text that is empty is a variable of the shell that was never set, not a wish.
void refuse_empty_texts(CLI::App& command) {
  const auto objection = [](const std::string& text) { return text.empty() ? "it is empty" : ""; };
  for (CLI::Option* option : command.get_options()) option->check(objection);
}

/// "--output=" behind which there is nothing: the next word would be the value.
void refuse_missing_values(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    for (const CLI::App* const named : app.get_subcommands({})) {
      if (named->get_name() == word) command = named;
    }
    if (word.starts_with("--") && word.ends_with('=') && word.find('=') == word.size() - 1) {
      refuse("{}: the value must not be empty; {}", word.substr(0, word.size() - 1), help_of(*command));
    }
  }
}

/// The first word, where a command is missing: options follow a command.
[[noreturn]] void refuse_without_command(const CLI::App& app, const std::string& word) {
  if (word.starts_with('-')) {
    refuse("option '{}' must follow a command; name the command first, one of {}", word,
           listed(command_names(app)));
  }
  if (word == "reproduce") {
    refuse(
        "unknown command '{}': a script of the source tree makes the paper's results; run ./dev "
        "reproduce there",
        word);
  }
  refuse("unknown command '{}': {}", word, did_you_mean(word, command_names(app)));
}

/// The command that is asked for; of a program without commands the program itself.
const CLI::App& asked_of(const CLI::App& app) {
  const auto asked = app.get_subcommands();
  return asked.empty() ? app : *asked.front();
}

/// Words on the command line that nothing takes. Without a command that is the first of them; behind one it
/// is the first option, whose value is left over too.
[[noreturn]] void refuse_extras(const CLI::App& app) {
  const auto extras = app.remaining(true);
  const auto is_option = [](const std::string& word) { return word.starts_with('-'); };
  const CLI::App& command = asked_of(app);
  if (&command == &app && !command_names(app).empty()) refuse_without_command(app, extras.front());
  const auto option = std::find_if(extras.begin(), extras.end(), is_option);
  if (option == extras.end()) {
    refuse("unknown argument '{}': {} has options only; {}", extras.front(), command.get_name(),
           help_of(command));
  }
  const auto known = option_names(command);
  const std::string name = option->substr(0, option->find('='));
  if (std::ranges::count(known, name) > 0) {
    refuse("option '{}' must follow the command; type nysalt {} {}", name, command.get_name(), name);
  }
  refuse("unknown option '{}': {}", *option, did_you_mean(name, known, help_of(command)));
}

/// What CLI11 says, with a part of it in our words.
std::string reworded(const CLI::Error& problem, std::string_view part, std::string_view ours) {
  std::string text = problem.what();
  if (const auto at = text.find(part); at != std::string::npos) text.replace(at, part.size(), ours);
  return text;
}

}  // namespace

std::string typed_after(const std::string& name, int argc, char** argv) {
  std::string value;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == name && i + 1 < argc) value = argv[i + 1];
    if (word.starts_with(name + "=")) value = word.substr(name.size() + 1);
  }
  return value;
}

std::optional<std::string> parse(CLI::App& app, int argc, char** argv) {
  if (const std::string file = typed_after("--config", argc, argv); !file.empty()) note_input(file);
  if (!app.parsed()) {  // checks stay, and would be made twice of an app that reads a second line
    refuse_empty_texts(app);
    for (CLI::App* command : app.get_subcommands({})) refuse_empty_texts(*command);
  }
  refuse_missing_values(app, argc, argv);
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::CallForHelp&) {
    const CLI::App& command = asked_of(app);
    return &command == &app ? app.help() : command.help(app.get_name());
  } catch (const CLI::CallForAllHelp&) {
    const CLI::App& command = asked_of(app);
    return &command == &app ? app.help("", CLI::AppFormatMode::All)
                            : command.help(app.get_name(), CLI::AppFormatMode::All);
  } catch (const CLI::CallForVersion&) {
    return fmt::format("{} {}\n", app.get_name(), version);
  } catch (const CLI::ConfigError& problem) {
    refuse("cannot read --config: {}; write TOML, with names of options of the command", problem.what());
  } catch (const CLI::ExtrasError&) {
    refuse_extras(app);
  } catch (const CLI::RequiredError& problem) {
    if (!app.remaining(true).empty()) refuse_extras(app);  // a mistyped option is why
    refuse("{} must be given; {}", reworded(problem, " is required", ""), help_of(asked_of(app)));
  } catch (const CLI::FileError& problem) {
    refuse("cannot read {}: the file is missing, or not readable; {}",
           reworded(problem, " was not readable (missing?)", ""), help_of(asked_of(app)));
  } catch (const CLI::ExcludesError& problem) {
    refuse("{}; {}", reworded(problem, " excludes ", " must come without "), help_of(asked_of(app)));
  } catch (const CLI::ValidationError& problem) {  // by an objection above
    refuse("{}: the value must not be empty; {}", reworded(problem, ": it is empty", ""),
           help_of(asked_of(app)));
  } catch (const CLI::ParseError& problem) {
    refuse("cannot read the options: {}; {}", problem.what(), help_of(asked_of(app)));
  }
}

}  // namespace nysalt::program
