// SPDX-License-Identifier: BSL-1.0
#include "comparison/recommendation.hpp"
#include "comparison/sampling_choice.hpp"
#include "program/systems.hpp"
#include "report/manifest.hpp"

#include "../commands.hpp"
#include "../output.hpp"
#include "comparison/all_ranks.hpp"
#include "nysalt/detail/collectively.hpp"

namespace nysalt::program {

namespace {

/// Does the work, prints what was found, and writes the scheme of a winner that was learned.
int print_result(auto& all, const std::string& output, const common_settings& common) {
  if (!output.empty()) on_first(all_ranks(), [&] { require_result(output); });
  warn_of_threads(common);
  all.learn_and_rank();
  const auto scheme = all.scheme();
  const bool writes = scheme && !output.empty();
  const auto write = [&] {
    if (writes) on_first(all_ranks(), [&] { write_result(output, *scheme, common); });
  };
  write_and_print(write, [&](bool written) {
    if (common.json) {
      json result = all.document();
      result["output"] = writes && written ? json(output) : json(nullptr);
      print(text_of(result));
      return;
    }
    print(all.readable());
    for (const auto& text : all.warnings()) warn(text);
    if (writes && written) print(line_of_written(output));
  });
  return all.has_result() ? done : no_result;
}

}  // namespace

int recommend(const recommend_command& command, const common_settings& common) {
  auto system = make_system(command.system);
  if (command.purpose == "sampling") {
    sampling_choice all(std::move(system), command.sampling, common);
    return print_result(all, command.output, common);
  }
  recommendation all(std::move(system), command, common);
  return print_result(all, command.output, common);
}

}  // namespace nysalt::program
