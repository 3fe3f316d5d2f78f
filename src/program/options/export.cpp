// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "../commands.hpp"
#include "number_option.hpp"
#include "nysalt/export_to.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_export(CLI::App& app, common_settings& common) {
  const auto asked = std::make_shared<export_command>();
  auto& command = *app.add_subcommand("export", "write a method as source for another language or code");
  command.add_option("METHOD", asked->method, "a name of nysalt list, or the file of a scheme or table")
      ->required();
  begin_group(command, method_options);
  add_number(command, "--step", asked->how.step,
             "of a scheme over several steps: the step to take, one of them or between them");
  command
      .add_option("--placement", asked->how.placement,
                  "where letters O of a bath are put into a method without them: end, symmetric or middle "
                  "[nowhere: no bath]")
      ->type_name(a_name);
  command.add_flag("--displaced", asked->how.displaced,
                   "gradient kicks G become displaced kicks D, which are not symplectic");
  begin_group(command, output_group);
  command.add_option("--to", asked->host, "the language or code to write for, one of those below")
      ->type_name("HOST");
  command
      .add_option("--template", asked->template_file,
                  "in place of --to: a template of your own, docs/how-to/export_template.md")
      ->type_name(a_file);
  command.add_option("--name", asked->how.name, "the identifier in the file [the family or method]")
      ->type_name(a_name);
  command.add_option("--output", asked->output, "the file to write [standard output]")->type_name(a_file);
  add_json(command, common);
  add_common(command, common);
  std::string hosts;
  for (const auto& host : export_hosts()) hosts += fmt::format("  {:14} {}\n", host.name, host.what);
  command.footer("Hosts:\n" + hosts +
                 "\nEach file has a self-test: ten steps that must end where nysalt's own do.\n\n"
                 "Examples:\n"
                 "  nysalt export srkn6b --to python --output srkn6b.py\n"
                 "  nysalt export fg4_processed --to c --displaced\n"
                 "  nysalt export bcss3 --to blackjax");
  return {&command, [asked, &common] { return export_method(*asked, common); }};
}

}  // namespace nysalt::program
