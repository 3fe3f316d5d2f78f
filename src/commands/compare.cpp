// SPDX-License-Identifier: BSL-1.0
#include "../comparison.hpp"

#include <filesystem>

#include "../commands.hpp"
#include "../output.hpp"

namespace nysalt::program {

int compare(const compare_command& command, const common_settings& common) {
  comparison all(command, common);
  const std::filesystem::path folder(command.output);
  if (!command.output.empty()) require_folder(folder);
  all.learn_and_measure();
  if (!command.output.empty()) all.write(folder);
  if (common.json) {
    print(text_of(all.document()));
  } else {
    print(all.readable());
    for (const auto& text : all.warnings()) warn(text);
    if (!command.output.empty()) print(fmt::format("Written: {}\n", command.output));
  }
  return all.has_result() ? done : no_result;
}

}  // namespace nysalt::program
