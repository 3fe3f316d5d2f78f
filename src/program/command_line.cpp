// SPDX-License-Identifier: BSL-1.0
#include "command_line.hpp"
#include "systems.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "as_typed.hpp"
#include "build_info.hpp"
#include "commands.hpp"
#include "comparison/checks.hpp"
#include "comparison/did_you_mean.hpp"
#include "comparison/prepared_problem.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/detail/together.hpp"
#include "options/subcommand.hpp"
#include "options_file.hpp"
#include "output.hpp"
#include "ranks.hpp"

namespace nysalt::program {

namespace {

constexpr const char* three_commands =
    "nysalt: learned symplectic integrators. Three commands to try:\n\n"
    "  nysalt list\n"
    "  nysalt learn --system fpu --step 0.03\n"
    "  nysalt compare --system fpu --steps 0.02,0.03 --methods "
    "verlet,verlet_2x,bcss2,srkn6b,learned:nystrom\n\n"
    "nysalt --help tells of all.\n";

/// A text that is empty is a variable of the shell that was never set, not a wish.
void refuse_empty_texts(CLI::App& command) {
  const auto objection = [](const std::string& text) { return text.empty() ? "it is empty" : ""; };
  for (CLI::Option* option : command.get_options()) option->check(objection);
}

/// Words on the command line that nothing takes. Without a command that is the first of them, as options
/// follow a command; behind one it is the first option, whose value is left over too.
[[noreturn]] void refuse_extras(const CLI::App& app) {
  const auto extras = app.remaining(true);
  const auto is_option = [](const std::string& word) { return word.starts_with('-'); };
  const auto asked = app.get_subcommands();
  if (asked.empty() && !is_option(extras.front())) {
    refuse("unknown command '{}': {}", extras.front(), did_you_mean(extras.front(), command_names(app)));
  }
  if (asked.empty()) {
    refuse("option '{}' before a command: name the command first, one of {}", extras.front(),
           listed(command_names(app)));
  }
  const CLI::App& command = *asked.front();
  const auto option = std::find_if(extras.begin(), extras.end(), is_option);
  if (option == extras.end()) {
    refuse("unknown argument '{}': {} has options only; {}", extras.front(), command.get_name(),
           help_of(command));
  }
  const auto known = option_names(command);
  const std::string name = option->substr(0, option->find('='));
  if (std::ranges::count(known, name) > 0) {
    refuse("option '{}' must stand behind the command: nysalt {} {}", name, command.get_name(), name);
  }
  refuse("unknown option '{}': {}", *option, did_you_mean(name, known, help_of(command)));
}

/// The help or the version, if that is asked for; else all options are read. Throws refusal.
std::optional<std::string> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::CallForHelp&) {
    const auto asked = app.get_subcommands();
    return asked.empty() ? app.help() : asked.front()->help("nysalt");
  } catch (const CLI::CallForVersion&) {
    return fmt::format("nysalt {}\n", version);
  } catch (const CLI::ConfigError& problem) {
    refuse("--config: {}; is the file TOML, and is each name an option of the command?", problem.what());
  } catch (const CLI::ExtrasError&) {
    refuse_extras(app);
  } catch (const CLI::RequiredError& problem) {
    if (!app.remaining(true).empty()) refuse_extras(app);  // a mistyped option is why
    refuse("{}; nysalt {} --help tells what it takes", problem.what(),
           app.get_subcommands().front()->get_name());
  } catch (const CLI::ParseError& problem) {
    const auto asked = app.get_subcommands();
    const std::string where = asked.empty() ? "nysalt" : "nysalt " + asked.front()->get_name();
    refuse("{}; {} --help tells what it takes", problem.what(), where);
  }
}

/// What follows a name on the command line, or the name and an =; the last if there are several.
std::string typed_after(const std::string& name, int argc, char** argv) {
  std::string value;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == name && i + 1 < argc) value = argv[i + 1];
    if (word.starts_with(name + "=")) value = word.substr(name.size() + 1);
  }
  return value;
}

/// The options of a system of the user's own are known only when it is loaded: before the others are read.
void load_named_system(int argc, char** argv) {
  std::string name = typed_after("--system", argc, argv);
  const std::string file = typed_after("--config", argc, argv);
  if (name.empty() && !file.empty()) {
    const auto is_word = [](const char* word) { return word[0] != '-'; };
    const auto command = std::find_if(argv + 1, argv + argc, is_word);
    name = system_in_options_file(file, command == argv + argc ? "" : *command);
  }
  if (!is_path_of_system(name)) return;
  on_first(world(), [&] { declaration_of(name); });  // compiles, if it must, once
  declaration_of(name);
}

}  // namespace

std::vector<subcommand> offer_all(CLI::App& app, common_settings& common) {
  try {
    return {offer_list(app, common),    offer_learn(app, common),     offer_run(app, common),
            offer_compare(app, common), offer_recommend(app, common), offer_stability(app, common),
            offer_new(app, common),     offer_build(app, common),     offer_reproduce(app, common),
            offer_cite(app, common)};
  } catch (const CLI::OptionAlreadyAdded& problem) {  // by the parameters of a system that was loaded
    std::string name = problem.what();                // "...: NAME is already added"
    name = name.substr(name.rfind(": ") == std::string::npos ? 0 : name.rfind(": ") + 2);
    refuse("a parameter of the system is called '{}', as an option is: choose another name",
           name.substr(0, name.find(' ')));
  }
}

namespace {

/// Ranks may have different numbers of threads.
std::string without_threads(const std::string& options) {
  std::istringstream lines(options);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("threads=") == std::string::npos) result += line + '\n';
  }
  return result;
}

}  // namespace

int run_command_line(int argc, char** argv) {
  load_named_system(argc, argv);
  common_settings common;
  common.threads = usual_threads();
  common.command = as_typed(argc, argv);
  CLI::App app("Learned symplectic integrators: learn one for a system and a step, run it, compare it.",
               "nysalt");
  app.set_version_flag("--version", version);
  app.require_subcommand(0, 1);
  app.get_formatter()->column_width(34);
  app.set_config("--config", "", "TOML file of options, as typed without the dashes");
  app.config_formatter(std::make_shared<options_file>(app));
  app.allow_config_extras(CLI::config_extras_mode::error);
  const std::vector<subcommand> all = offer_all(app, common);
  for (auto* command : app.get_subcommands({})) {
    command->footer("--config FILE holds options, as typed without the dashes (TOML).\n\n" +
                    command->get_footer());
  }
  refuse_empty_texts(app);
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_texts(*command);
  app.footer(
      "nysalt COMMAND --help tells of each.\nExit codes: 0 done, 2 bad input, 3 every trajectory diverged or "
      "the fit is not usable.");
  if (const auto answer = parse(app, argc, argv)) {
    print(*answer);
    return done;
  }
  common.options = app.config_to_str();
  require_agreement("options", without_threads(common.options));
  const auto asked = app.get_subcommands();
  if (asked.empty()) {
    print(three_commands);
    return done;
  }
  require_sound(common);
  const auto found = std::ranges::find(all, asked.front(), &subcommand::options);
  return found->run();
}

}  // namespace nysalt::program
