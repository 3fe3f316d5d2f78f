// SPDX-License-Identifier: BSL-1.0
#include <fmt/format.h>

#include "../commands.hpp"
#include "../output.hpp"
#include "comparison/all_ranks.hpp"
#include "comparison/json.hpp"
#include "exports/exported_source.hpp"
#include "exports/exports.hpp"
#include "nysalt/detail/together.hpp"
#include "report/manifest.hpp"

namespace nysalt::program {

int export_method(const export_command& command, const common_settings& common) {
  on_first(all_ranks(), [&] {
    const export_host& host = find_export_host(command.host);
    if (!command.output.empty()) require_writable(command.output);
    const method_source source = find_method(command.method);
    const exported_method exported = exported_from(source, command.how);
    const run_time_word& word = exported.method.letters();
    const std::string text = host.text(exported);
    if (source.learned && !source.learned->usable) {
      warn(fmt::format("the fit {} is not to be used: {}", source.typed, source.learned->reason));
    }
    if (!command.output.empty()) write_result(command.output, text, common);
    if (common.json) {
      print(text_of(json{{"host", host.name},
                         {"name", exported.name},
                         {"letters", word.letters()},
                         {"coefficients", exported.method.coefficients()},
                         {"evaluations_per_step", word.evaluations_per_step},
                         {"output", command.output.empty() ? json() : json(command.output)},
                         {"text", text}}));
    } else if (command.output.empty()) {
      print(text);
    } else {
      print(fmt::format("Written: {}\n", command.output));
    }
  });
  return done;
}

}  // namespace nysalt::program
