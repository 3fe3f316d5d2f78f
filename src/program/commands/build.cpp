// SPDX-License-Identifier: BSL-1.0
#include "../../plugin/build.hpp"
#include "program/systems.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "../commands.hpp"
#include "../options/subcommand.hpp"
#include "../output.hpp"
#include "comparison/described.hpp"
#include "comparison/inputs.hpp"
#include "comparison/prepared_problem.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

int build(const build_command& command, const common_settings& common) {
  const std::string to = library_of(command.source, command.output);
  note_input(command.source);
  require_writable(to);
  const std::string path = build_library(command.source, to);
  const auto& system = declaration_of(path);
  CLI::App all;
  common_settings unused;
  offer_all(all, unused);  // its parameters may not have the names of options
  if (common.json) {
    print(text_of({{"version", version_of_documents},
                   {"output", path},
                   {"name", system.name},
                   {"title", system.title},
                   {"options", options_of(system)}}));
  } else {
    print(fmt::format(
        "Built: {}\n{}: {}\noptions: {}\nTry: nysalt stability --system {} --method verlet --step 0.1\n",
        path, system.name, system.title, options_of(system), path));
  }
  return done;
}

}  // namespace nysalt::program
