// SPDX-License-Identifier: BSL-1.0
#include "report/comparison_report.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "../commands.hpp"
#include "../mpi_session.hpp"
#include "../output.hpp"
#include "../systems.hpp"
#include "comparison/inputs.hpp"
#include "comparison/json.hpp"
#include "comparison/ranking.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/communicator.hpp"

namespace nysalt::program {

namespace {

constexpr int unfinished = -1;  // no exit code

/// The report, if the folder has a whole one. Throws refusal if it answers another question.
std::optional<json> finished_report(const std::filesystem::path& folder, const json& question) {
  for (const char* file : {"report.html", "rows.csv"}) {
    if (!is_there(folder / file)) return std::nullopt;
  }
  json report = document_in(folder / "report.json");
  if (!report.is_object() || !report.contains("question")) return std::nullopt;
  require_same_question(report["question"], question, folder / "report.json");
  for (const char* kept : {"question", "provenance"}) report.erase(kept);
  return report;
}

bool has_value(const json& report) {
  const json rows = report.value("rows", json::array());
  return std::ranges::any_of(rows, [](const json& row) { return row.value("reason", json()).is_null(); });
}

/// Prints the report, if the folder has a whole one: the exit code.
int print_finished_report(const std::filesystem::path& folder, const comparison& all) {
  if (is_there(folder / work_of_report)) return unfinished;
  const auto there = finished_report(folder, all.question());
  if (!there) return unfinished;
  print(all.common().json ? text_of(*there)
                          : fmt::format("It is finished: {}\n", of_letters(folder.string())));
  return has_value(*there) ? done : no_result;
}

/// If the comparison fails, only the work file with the finished parts stays.
void measure_in(const std::filesystem::path& folder, comparison& all, bool resume) {
  std::vector<std::filesystem::path> made;
  on_first(all_ranks(), [&] { made = make_folder(folder); });
  work_file kept(folder / work_of_report, all.question(), resume);
  try {
    all.learn_and_measure(kept);
  } catch (...) {
    if (kept.is_empty()) {  // only rank 0 has something to remove
      kept.remove();
      std::error_code ignored;
      for (auto path = made.rbegin(); path != made.rend(); ++path) std::filesystem::remove(*path, ignored);
    }
    throw;
  }
  on_first(all_ranks(), [&] {
    for (const auto& text : write_report(all, folder)) warn(text);
  });
  tell_of_parts(&kept);
  kept.remove();
}

}  // namespace

int compare(const compare_command& command, const common_settings& common) {
  comparison_options asked = command;
  asked.energies = !command.output.empty();
  std::optional<comparison> planned;
  collectively(all_ranks(), [&] { planned.emplace(make_system(command.system), asked, common); });
  comparison& all = *planned;
  require_agreement("methods", all.question().dump(-1, ' ', false, json::error_handler_t::replace));
  warn_of_threads(common);
  const std::filesystem::path folder(command.output);
  if (command.output.empty()) {
    if (command.resume)
      refuse("--resume must come with --output; name the folder of the comparison to go on with");
    work_file nowhere;
    all.learn_and_measure(nowhere);
  } else {
    int code = unfinished;
    on_first(all_ranks(), [&] {
      require_files_in(folder, {"report.json", "report.html", "rows.csv", work_of_report});
      if (const auto schemes = all.scheme_files(); !schemes.empty()) {
        require_files_in(folder / folder_of_schemes, schemes);
      }
      if (command.resume) code = print_finished_report(folder, all);
    });
    broadcast(all_ranks(), code);
    if (code != unfinished) return code;
    measure_in(folder, all, command.resume);
  }
  if (common.json) {
    print(text_of(document_of(all)));
  } else {
    print(readable(all, form_of(common)));
    for (const auto& text : all.warnings()) warn(text);
    if (!command.output.empty()) print(line_of_written(command.output));
  }
  if (all.has_result()) return done;
  warn(
      "no method has an error to show, as all diverged or none could be measured; take smaller --steps, or a "
      "shorter --horizon");
  return no_result;
}

}  // namespace nysalt::program
