// SPDX-License-Identifier: BSL-1.0
// nysalt_ratios FOLDER: from the folder's g++.*.json and clang++.*.json, which the races wrote, the table on
// stdout, and ratios.json and the picture into the folder.
#include <cstdio>
#include <exception>

#include "../processor.hpp"
#include "document.hpp"
#include "heaviest_run.hpp"
#include "picture.hpp"
#include "rows.hpp"

namespace {

using namespace nysalt::bench;

nlohmann::ordered_json machine(const measurements& gnu, const measurements& clang) {
  nlohmann::ordered_json result{{"processor", processor()}, {"cores", gnu.context.value("num_cpus", 0)}};
  for (const char* key : {"l1_bytes", "l2_bytes", "l3_bytes"}) {
    result[key] = std::stoll(gnu.context.value(key, std::string("0")));
  }
  for (const auto* build : {&gnu, &clang}) {
    result["compilers"].push_back(build->context.value("compiler", "unknown") + " " +
                                  build->context.value("flags", ""));
  }
  return result;
}

nlohmann::ordered_json times(const measurements& gnu, const measurements& clang) {
  nlohmann::ordered_json result;
  for (const auto& [race, runners] : gnu.races) {
    for (const auto& [runner, all] : runners) {
      result[race][runner]["g++"] = median(all);
      if (clang.has(race, runner)) result[race][runner]["clang++"] = median(clang.of(race, runner));
    }
  }
  return result;
}

struct judged_rows {
  std::vector<judged_row> asked;
  std::vector<judged_row> told;
};

judged_rows judge_all(const measurements& gnu, const measurements& clang) {
  judged_rows result;
  const auto judge_row = [&](const row& r) {
    return r.compiler == "g++" ? judge(r, gnu, &clang) : judge(r, clang, &gnu);
  };
  for (const auto& r : fixed_rows()) result.asked.push_back(judge_row(r));
  for (const auto& g : growths()) result.asked.push_back(judge_row(growth_row(g, gnu)));
  for (const auto& r : reported_rows()) {
    if (is_there(gnu, r)) result.told.push_back(judge_row(r));
  }
  return result;
}

nlohmann::ordered_json document(const judged_rows& rows, const measurements& gnu, const measurements& clang) {
  nlohmann::ordered_json result{{"machine", machine(gnu, clang)},
                                {"ratios", nlohmann::ordered_json::array()}};
  for (const auto& j : rows.asked) result["ratios"].push_back(to_json(j));
  for (const auto& j : rows.told) result["reported"].push_back(to_json(j));
  result["nanoseconds"] = times(gnu, clang);
  return result;
}

/// All that there is to read; `form` makes text of a table.
std::string pages(const judged_rows& rows, const measurements& gnu, const measurements& clang, auto form) {
  const auto machine_facts = machine(gnu, clang);
  std::string text = fmt::format(
      "{}, {} cores; caches of {} kB, {} kB and {} kB\n", machine_facts["processor"].get<std::string>(),
      machine_facts["cores"].get<int>(), machine_facts["l1_bytes"].get<std::int64_t>() / 1024,
      machine_facts["l2_bytes"].get<std::int64_t>() / 1024,
      machine_facts["l3_bytes"].get<std::int64_t>() / 1024);
  for (const std::string compiler : machine_facts["compilers"]) text += fmt::format("{}\n", compiler);
  text += "\n" + form(to_table(rows.asked));
  std::string remarks;
  for (const auto& j : rows.asked) {
    if (!j.said.reason.empty()) remarks += fmt::format("- {}: {}\n", j.row.name, j.said.reason);
    if (!j.row.note.empty()) remarks += fmt::format("- {}: {}\n", j.row.name, j.row.note);
  }
  for (const auto* build : {&gnu, &clang}) {
    for (const auto& [race, why] : build->failures)
      remarks += fmt::format("- the race '{}' failed: {}\n", race, why);
  }
  text += "\n" + remarks + "\nReported without a target:\n\n" + form(to_table(rows.told));
  for (const auto& g : growths())
    text += fmt::format("\n{}, nanoseconds:\n\n", g.name) + form(to_table(g, gnu, clang));
  text += "\nThe heaviest run of the paper, 10^4 trajectories in a bath over a time of 40:\n\n" +
          form(heaviest_run(gnu, clang));
  if (gnu.has("compiling", "with learner")) {
    text +=
        fmt::format("\nCompiling a first example takes g++ {:.1f} s with the learner, {:.1f} s without.\n",
                    1e-9 * median(gnu.of("compiling", "with learner")),
                    1e-9 * median(gnu.of("compiling", "without learner")));
  }
  return text;
}

void report(const measurements& gnu, const measurements& clang, const std::filesystem::path& folder) {
  const auto rows = judge_all(gnu, clang);
  nysalt::write_file(folder / "ratios.json", document(rows, gnu, clang).dump(2) + "\n");
  const auto as_markdown = [](const nysalt::table& t) { return t.markdown(); };
  nysalt::write_file(folder / "table.md", pages(rows, gnu, clang, as_markdown));
  fmt::print("{}", pages(rows, gnu, clang, [](const nysalt::table& t) { return t.text(); }));
  if (!draw(bars_under_the_roof(gnu, clang), margins(rows.asked), folder)) {
    fmt::print("no picture: gnuplot is not there or failed\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: nysalt_ratios FOLDER\n");
    return 2;
  }
  try {
    report(read_measurements_of(argv[1], "g++"), read_measurements_of(argv[1], "clang++"), argv[1]);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "nysalt_ratios: {}\n", problem.what());
    return 1;
  }
}
