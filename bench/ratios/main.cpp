// SPDX-License-Identifier: BSL-1.0
// nysalt_ratios FOLDER: from the folder's g++.*.json and clang++.*.json, which the races wrote, the table on
// stdout, and ratios.json and the picture into the folder.
#include <cstdio>
#include <exception>
#include <fstream>

#include "document.hpp"
#include "picture.hpp"
#include "rows.hpp"

namespace {

using namespace nysalt::bench;

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

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

void report(const measurements& gnu, const measurements& clang, const std::filesystem::path& folder) {
  std::vector<judged_row> asked;
  std::vector<judged_row> told;
  const auto judge_row = [&](const row& r) {
    return r.compiler == "g++" ? judge(r, gnu, &clang) : judge(r, clang, &gnu);
  };
  for (const auto& r : fixed_rows()) asked.push_back(judge_row(r));
  for (const auto& g : growths()) asked.push_back(judge_row(growth_row(g, gnu)));
  for (const auto& r : reported_rows()) {
    if (is_there(gnu, r)) told.push_back(judge_row(r));
  }

  nlohmann::ordered_json document{{"machine", machine(gnu, clang)},
                                  {"ratios", nlohmann::ordered_json::array()}};
  for (const auto& j : asked) document["ratios"].push_back(to_json(j));
  for (const auto& j : told) document["reported"].push_back(to_json(j));
  document["nanoseconds"] = times(gnu, clang);
  nysalt::write_file(folder / "ratios.json", document.dump(2) + "\n");

  fmt::print("{}\n", to_table(asked).text());
  for (const auto& j : asked) {
    if (!j.said.reason.empty()) fmt::print("? {}: {}\n", j.row.name, j.said.reason);
    if (!j.row.note.empty()) fmt::print("{}: {}\n", j.row.name, j.row.note);
  }
  fmt::print("\nbeside it, without a target:\n\n{}\n", to_table(told).text());
  for (const auto* build : {&gnu, &clang}) {
    for (const auto& [race, why] : build->failures) fmt::print("! the race '{}' failed: {}\n", race, why);
  }
  if (!draw(bars_under_the_roof(gnu, clang), margins(asked), folder)) {
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
