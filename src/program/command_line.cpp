// SPDX-License-Identifier: BSL-1.0
#include "command_line.hpp"
#include "systems.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "command_text.hpp"
#include "commands.hpp"
#include "comparison/checks.hpp"
#include "comparison/prepared_problem.hpp"
#include "comparison/refusal.hpp"
#include "mpi_session.hpp"
#include "nysalt/communicator.hpp"
#include "options/shared_options.hpp"
#include "options/subcommand.hpp"
#include "options_file.hpp"
#include "output.hpp"
#include "parse.hpp"

namespace nysalt::program {

namespace {

constexpr const char* three_commands =
    "nysalt: learned symplectic integrators. Three commands to try:\n\n"
    "  nysalt list\n"
    "  nysalt learn --system fpu --step 0.03\n"
    "  nysalt compare --system fpu --steps 0.02,0.03 --methods "
    "verlet,verlet_2x,bcss2,srkn6b,learned:nystrom\n\n"
    "nysalt --help lists all commands.\n";

/// The options of a system of the user's own are known only when it is loaded: before the others are read.
void load_named_system(int argc, char** argv) {
  const std::string name = typed_after("--system", argc, argv);
  if (!is_path_of_system(name)) return;
  on_first(all_ranks(), [&] { declaration_of(name); });  // compiles, if it must, once
  declaration_of(name);
}

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
  common.execution.threads = usual_threads();
  common.command = command_text(argc, argv);
  CLI::App app("Learned symplectic integrators: learn one for a system and a step, run it, compare it.",
               "nysalt");
  app.require_subcommand(0, 1);
  add_of_program(app);
  const std::vector<subcommand> all = offer_all(app, common);
  app.footer(
      "nysalt COMMAND --help describes a command.\nExit codes: 0 done, 2 bad input, 3 every trajectory "
      "diverged or the fit is not usable, 4 a result could not be written.");
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
