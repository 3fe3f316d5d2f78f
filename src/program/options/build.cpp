// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>

#include "../commands.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_build(CLI::App& app, common_settings& common) {
  const auto asked = std::make_shared<build_command>();
  auto& command = *app.add_subcommand("build", "compile a system of your own, for --system");
  command.add_option("SOURCE", asked->source, "the .hpp file that declares the system by NYSALT_SYSTEM")
      ->type_name(a_file)
      ->required();
  begin_group(command, output_group);
  command.add_option("--output", asked->output, "the library to write [./SOURCE.so]")->type_name(a_file);
  add_json(command, common);
  add_common(command, common);
  command.footer(
      "A source is code that runs as you: build what you trust. --system SOURCE.hpp builds it too.\n\n"
      "Examples:\n"
      "  nysalt build morse_chain.hpp\n"
      "  nysalt build morse_chain.hpp --output systems/morse_chain.so");
  return {&command, [asked, &common] { return build(*asked, common); }};
}

subcommand offer_new(CLI::App& app, common_settings& common) {
  const auto asked = std::make_shared<new_command>();
  auto& command = *app.add_subcommand("new", "begin a system of your own: a commented source that builds");
  command.add_option("NAME", asked->name, "the name of the system, whose source NAME.hpp is written here")
      ->required();
  begin_group(command, output_group);
  add_json(command, common);
  add_common(command, common);
  command.footer("Examples:\n  nysalt new morse_chain");
  return {&command, [asked, &common] { return new_system(*asked, common); }};
}

}  // namespace nysalt::program
