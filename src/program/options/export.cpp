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
  command.add_option("METHOD", asked->method, "a name, or the file of a scheme or table")->required();
  command.add_option("--to", asked->host, "the language or code, one of those below");
  command.add_option("--template", asked->template_file,
                     "instead of --to: the file of a template of one's own, docs/how-to/export_template.md");
  command.add_option("--output", asked->output, "the file [standard output]");
  command.add_option("--name", asked->how.name, "identifier in the file [the family or method]");
  add_number(command, "--step", asked->how.step,
             "of a scheme over several steps: one of them, or between them");
  command.add_option("--placement", asked->how.placement,
                     "of letters O in a method without them: end, symmetric or middle [none: no bath]");
  command.add_flag("--displaced", asked->how.displaced,
                   "gradient kicks G become displaced kicks D, not symplectic");
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
