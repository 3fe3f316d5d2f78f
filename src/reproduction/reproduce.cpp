// SPDX-License-Identifier: BSL-1.0
#include "reproduce.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "comparison/all_ranks.hpp"
#include "comparison/progress.hpp"
#include "comparison/refusal.hpp"
#include "parts.hpp"
#include "program/commands.hpp"
#include "program/output.hpp"
#include "report.hpp"

namespace nysalt::program::paper {

namespace {

std::vector<part_of_paper> parts_named(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const auto& part : parts_of_paper()) known.push_back(part.name);
  for (const auto& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    refuse("unknown part '{}' of the paper: it is one of {}", name, listed(known));
  }
  std::vector<part_of_paper> result;
  for (const auto& part : parts_of_paper()) {
    const bool wanted = names.empty() || std::find(names.begin(), names.end(), part.name) != names.end();
    if (wanted) result.push_back(part);
  }
  return result;
}

/// Reports the progress, and how long the rest may take: as planned, by how long the plan has taken so far.
class timetable {
 public:
  explicit timetable(const std::vector<part_of_paper>& parts) {
    for (const auto& part : parts) {
      for (const auto& one : part.exhibits) all_ += one.seconds;
    }
  }
  std::string next(const planned& one) {
    const auto passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    std::string text = one.what;
    if (done_ > 0.02 * all_) text += fmt::format(", some {:.0f} s left", passed / done_ * (all_ - done_));
    done_ += one.seconds;
    return text;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double all_ = 0.0;
  double done_ = 0.0;
};

}  // namespace

int reproduce(const reproduce_command& command, const common_settings& common) {
  if (!all_ranks().is_single()) refuse("nysalt_paper must run as one process; start it without mpirun");
  const auto planned = parts_named(command.parts);
  if (!command.output.empty()) {
    require_files_in(command.output, {"paper.json", "paper.md", "paper.html"});
    require_folder(std::filesystem::path(command.output) / folder_of_pictures);
  }
  progress shown;
  const setting setup(common, command.quick);
  timetable plan(planned);
  std::vector<finished_part> finished;
  for (const auto& part : planned) {
    finished.push_back({part.name, part.title, {}});
    for (const auto& one : part.exhibits) {
      shown.part(plan.next(one));
      const auto start = std::chrono::steady_clock::now();
      finished.back().exhibits.push_back(one.make(setup));
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
      finished.back().exhibits.back().seconds = passed.count();
    }
  }
  shown.clear();
  const reproduction_report report(std::move(finished), command.quick, common);
  if (!command.output.empty()) report.write(command.output);
  print(common.json ? text_of(report.document()) : report.summary());
  if (!common.json && !command.output.empty()) print(fmt::format("Written: {}\n", command.output));
  return done;
}

}  // namespace nysalt::program::paper
