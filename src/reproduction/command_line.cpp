// SPDX-License-Identifier: BSL-1.0
#include "command_line.hpp"

#include <CLI/CLI.hpp>

#include "comparison/checks.hpp"
#include "program/command_text.hpp"
#include "program/commands.hpp"
#include "program/mpi_session.hpp"
#include "program/options/shared_options.hpp"
#include "program/output.hpp"
#include "program/parse.hpp"
#include "reproduce.hpp"

namespace nysalt::program::paper {

int run_command_line(int argc, char** argv) {
  common_settings common;
  common.execution.threads = usual_threads();
  common.command = command_text(argc, argv);
  reproduce_command asked;
  CLI::App app("The paper's tables and figures beside our own.", "nysalt_paper");
  add_of_program(app);
  app.add_option("parts", asked.parts, "linear, deterministic, langevin [all; some ten minutes]");
  app.add_option("--output", asked.output, "a folder to write: paper.md, paper.html, paper.json and pictures")
      ->type_name("FOLDER");
  app.add_flag("--quick", asked.quick, "take few trajectories and steps, to see it run");
  add_common(app, common);
  app.footer(
      "Examples:\n"
      "  nysalt_paper linear\n"
      "  nysalt_paper deterministic langevin --quick --output results\n\n"
      "Exit codes: 0 done, 2 bad input, 4 a result could not be written.");
  if (const auto answer = parse(app, argc, argv)) {
    print(*answer);
    return done;
  }
  common.options = app.config_to_str();
  require_sound(common);
  return reproduce(asked, common);
}

}  // namespace nysalt::program::paper
