// SPDX-License-Identifier: BSL-1.0
#include "comparison/recommendation.hpp"
#include "program/systems.hpp"
#include "report/manifest.hpp"

#include "../commands.hpp"
#include "../output.hpp"
#include "comparison/all_ranks.hpp"
#include "nysalt/detail/together.hpp"

namespace nysalt::program {

int recommend(const recommend_command& command, const common_settings& common) {
  recommendation all(make_system(command.system), command, common);
  if (!command.output.empty()) on_first(all_ranks(), [&] { require_writable(command.output); });
  warn_of_threads(common);
  all.learn_and_rank();
  const auto scheme = all.scheme();
  const bool writes = scheme && !command.output.empty();
  if (writes) on_first(all_ranks(), [&] { write_result(command.output, *scheme, common); });
  if (common.json) {
    json result = all.document();
    result["output"] = writes ? json(command.output) : json(nullptr);
    print(text_of(result));
  } else {
    print(all.readable());
    for (const auto& text : all.warnings()) warn(text);
    if (writes) print(fmt::format("Written: {}\n", command.output));
  }
  return all.has_result() ? done : no_result;
}

}  // namespace nysalt::program
