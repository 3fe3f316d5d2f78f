// SPDX-License-Identifier: BSL-1.0
#include "report.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <ctime>
#include <map>

#include "build_info.hpp"
#include "program/output.hpp"
#include "report/machine.hpp"
#include "report/page.hpp"

namespace nysalt::program::paper {

namespace {

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))); }

std::map<std::string, int> counted(const std::vector<finished_part>& parts) {
  std::map<std::string, int> count;
  for (const auto& part : parts) {
    for (const auto& one : part.exhibits) {
      for (const auto& outcome : one.claims) {
        ++count[outcome.verdict.starts_with("depends on") ? "depends on how the text is read"
                                                          : outcome.verdict];
      }
    }
  }
  return count;
}

table summary_table(const finished_part& part) {
  table rows({"claim", "ours", "verdict"}, 3);
  for (const auto& one : part.exhibits) {
    for (const auto& outcome : one.claims) rows.add({outcome.claim, outcome.ours, outcome.verdict});
  }
  return rows;
}

void describe(page& report, const tested_claim& outcome) {
  const std::vector<std::string> facts{fmt::format("Measured: {}.", outcome.quantity),
                                       fmt::format("Ours: {}.", outcome.ours),
                                       fmt::format("**{}**: {}.", outcome.verdict, outcome.reason)};
  report.text(fmt::format("**Claim:** {}.", outcome.claim));
  report.list(facts);
  if (!outcome.command.empty()) report.code(outcome.command);
}

void describe(page& report, const exhibit& one) {
  report.subheading(one.title);
  report.text(fmt::format("{}.", one.place));
  for (const auto& outcome : one.claims) describe(report, outcome);
  for (const auto& remark : one.remarks) report.text(remark);
  for (const auto& [sentence, rows] : one.tables) {
    report.text(sentence);
    report.table(rows);
  }
  for (const auto& illustration : one.pictures) report.picture(illustration.picture, illustration.caption);
}

constexpr const char* of_quick_runs =
    "This is a quick run, of few trajectories and steps: it shows that everything runs, and its verdicts "
    "have no weight.";

}  // namespace

reproduction_report::reproduction_report(std::vector<finished_part> parts, bool quick,
                                         const common_settings& common)
    : parts_(std::move(parts)), quick_(quick), common_(common) {}

json reproduction_report::document() const {
  json items = json::array();
  for (const auto& part : parts_) {
    for (const auto& one : part.exhibits) {
      for (const auto& outcome : one.claims) {
        items.push_back({{"part", part.name},
                         {"exhibit", one.title},
                         {"place", one.place},
                         {"claim", outcome.claim},
                         {"quantity", outcome.quantity},
                         {"ours", outcome.ours},
                         {"verdict", outcome.verdict},
                         {"reason", outcome.reason},
                         {"command", outcome.command.empty() ? json(nullptr) : json(outcome.command)}});
      }
    }
  }
  return {{"quick", quick_}, {"seed", common_.seed}, {"items", items}};
}

std::string reproduction_report::summary() const {
  std::string text;
  if (quick_) text += fmt::format("{}\n\n", of_quick_runs);
  for (const auto& part : parts_) {
    text += fmt::format("{}\n\n", part.title);
    for (const auto& one : part.exhibits) {
      for (const auto& outcome : one.claims) {
        text += fmt::format("  {}\n    ours: {}\n    {}\n", outcome.claim, outcome.ours, outcome.verdict);
      }
    }
    text += "\n";
  }
  for (const auto& [verdict, count] : counted(parts_)) text += fmt::format("{}: {}\n", verdict, count);
  return text;
}

void reproduction_report::write(const std::filesystem::path& folder) const {
  page report("The paper's claims, computed again");
  report.text(
      "Li, Lu, Tao, Ye: NySALT: Nystrom-type inference-based schemes adaptive to large time-stepping, "
      "Journal of "
      "Computational Physics 477 (2023). Every table and figure, its claims as they are printed, and what "
      "comes "
      "out here. The command below makes this page again.");
  report.code(common_.command);
  report.text(
      fmt::format("{}, nysalt {}, {}, {}, seed {}.", today(), version, machine(), compiler, common_.seed));
  if (quick_) report.text(of_quick_runs);
  report.text(
      "A verdict follows from numbers by the rule beside it: **reproduced**, **not reproduced**, or "
      "**depends on** "
      "what the text leaves open; then all readings are computed. A printed number is reproduced within half "
      "of "
      "its last digit and two standard errors. Values are with one standard error.");
  std::vector<std::string> counts;
  for (const auto& [verdict, count] : counted(parts_))
    counts.push_back(fmt::format("{}: {}", verdict, count));
  report.list(counts);
  for (const auto& part : parts_) {
    report.heading(fmt::format("{}: summary", part.title));
    report.table(summary_table(part));
  }
  for (const auto& part : parts_) {
    report.heading(part.title);
    for (const auto& one : part.exhibits) describe(report, one);
  }
  const auto pictures = folder / folder_of_pictures;
  make_folder(pictures);
  for (const auto& picture : report.figures()) {
    if (const auto warning = write_pictures(picture, pictures); !warning.empty()) warn(warning);
  }
  write_result(folder / "paper.md", report.markdown(folder_of_pictures));
  write_result(folder / "paper.html", report.html(pictures));
  json all = document();
  all["made"] = {{"date", today()}, {"machine", machine()}, {"compiler", compiler}, {"version", version}};
  all["exhibits"] = json::array();
  for (const auto& part : parts_) {
    for (const auto& one : part.exhibits)
      all["exhibits"].push_back({{"title", one.title}, {"seconds", one.seconds}});
  }
  write_document(folder / "paper.json", all, common_);
}

}  // namespace nysalt::program::paper
