// SPDX-License-Identifier: BSL-1.0
#include "../comparison.hpp"

#include <filesystem>
#include <fstream>
#include <optional>

#include "../commands.hpp"
#include "../output.hpp"
#include "../ranking.hpp"
#include "../refusal.hpp"

namespace nysalt::program {

namespace {

/// The report on the very question, if it is there.
std::optional<json> answer(const std::filesystem::path& folder, const json& question) {
  std::ifstream input(folder / "report.json");
  json report = json::parse(input, nullptr, false);
  if (!report.is_object() || report.value("question", json()) != question) return std::nullopt;
  report.erase("question");
  return report;
}

}  // namespace

int compare(const compare_command& command, const common_settings& common) {
  comparison all(command, common);
  const std::filesystem::path folder(command.output);
  journal kept;
  if (command.output.empty()) {
    if (command.resume) refuse("--resume goes on with what stands in a folder: name it as --output");
  } else {
    require_folder(folder);
    const auto file = folder / "journal.jsonl";
    if (command.resume && !std::filesystem::exists(file)) {
      if (const auto there = answer(folder, all.question())) {
        print(common.json ? text_of(*there) : fmt::format("It is finished: {}\n", command.output));
        return done;
      }
    }
    make_folder(folder);
    kept = journal(file, all.question(), command.resume);
    if (kept.found() > 0) warn(fmt::format("{} finished parts are taken from the journal", kept.found()));
  }
  all.learn_and_measure(kept);
  if (!command.output.empty()) write_report(all, folder);
  kept.remove();
  if (common.json) {
    print(text_of(document_of(all)));
  } else {
    print(readable(all));
    for (const auto& text : all.warnings()) warn(text);
    if (!command.output.empty()) print(fmt::format("Written: {}\n", command.output));
  }
  return all.has_result() ? done : no_result;
}

}  // namespace nysalt::program
