// SPDX-License-Identifier: BSL-1.0
#include <fmt/format.h>

#include "../commands.hpp"
#include "../output.hpp"
#include "comparison/all_ranks.hpp"
#include "comparison/described.hpp"
#include "comparison/exported_source.hpp"
#include "nysalt/communicator.hpp"
#include "report/result_file.hpp"

namespace nysalt::program {

int export_method(const export_command& command, const common_settings& common) {
  on_first(all_ranks(), [&] {
    const method_source source = find_method(command.method);
    const export_source exported = exported_from(source, command.how);
    const std::string text = export_text(command.host, command.template_file, exported);
    if (!command.output.empty()) require_result(command.output);  // once all files that are read are known
    const nysalt::word& word = exported.method.letters();
    if (source.learned && !source.learned->usable) {
      warn(fmt::format("the fit {} is not to be used: {}", source.typed, source.learned->reason));
    }
    if (!command.output.empty()) write_result(command.output, text);
    if (common.json) {
      print(text_of(
          json{{"version", version_of_documents},
               {"host", command.host.empty() ? command.template_file : command.host},
               {"name", exported.options.name.empty() ? exported.method.name() : exported.options.name},
               {"letters", word.letters()},
               {"coefficients", exported.method.coefficients()},
               {"evaluations_per_step", word.evaluations_per_step},
               {"output", command.output.empty() ? json() : json(command.output)},
               {"text", text}}));
    } else if (command.output.empty()) {
      print(text);
    } else {
      print(line_of_written(command.output));
    }
  });
  return done;
}

}  // namespace nysalt::program
