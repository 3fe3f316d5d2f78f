// SPDX-License-Identifier: BSL-1.0
// The rows as a JSON document and as a table.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../src/report/table.hpp"
#include "row.hpp"

namespace nysalt::bench {

inline std::string other_compiler(const row& r) { return r.compiler == "g++" ? "clang++" : "g++"; }

inline nlohmann::ordered_json to_json(const judged_row& j) {
  const auto scatter = [](const ratio& r) {
    return nlohmann::ordered_json{
        {"value", r.value}, {"interval", {r.low, r.high}}, {"spread", r.spread}, {"pairs", r.pairs}};
  };
  nlohmann::ordered_json result{{"name", j.row.name}};
  result.update(scatter(j.found));
  if (j.row.bound) {
    result["target"] = *j.row.bound;
    result["relation"] = j.row.measure == measure::speed ? ">=" : "<=";
    result["holds"] = j.said.holds ? nlohmann::ordered_json(*j.said.holds) : nlohmann::ordered_json(nullptr);
    if (!j.said.holds) result["reason"] = j.said.reason;
  }
  result["compiler"] = j.row.compiler;
  result["race"] = j.row.race;
  result["subject"] = {{"name", j.row.subject}, {"ns", j.subject_ns}};
  result["against"] = {{"name", j.against}, {"ns", j.against_ns}};
  if (!j.row.note.empty()) result["note"] = j.row.note;
  if (j.beside) result[other_compiler(j.row)] = scatter(*j.beside);
  return result;
}

inline nysalt::table to_table(const std::vector<judged_row>& rows) {
  nysalt::table result({"what", "target", "holds", "g++", "95 %", "clang++", "95 %"});
  const auto number = [](const ratio& r) { return fmt::format("{:.3g}", r.value); };
  const auto interval = [](const ratio& r) { return fmt::format("{:.3g} - {:.3g}", r.low, r.high); };
  for (const auto& j : rows) {
    std::vector<std::string> cells{j.row.name, "", ""};
    if (j.row.bound) {
      cells[1] = fmt::format("{} {:g}", j.row.measure == measure::speed ? ">=" : "<=", *j.row.bound);
      cells[2] = !j.said.holds ? "?" : *j.said.holds ? "yes" : "NO";
    }
    std::vector<std::string> mine{number(j.found), interval(j.found)};
    std::vector<std::string> others{j.beside ? number(*j.beside) : "-", j.beside ? interval(*j.beside) : "-"};
    if (j.row.compiler != "g++") std::swap(mine, others);
    cells.insert(cells.end(), mine.begin(), mine.end());
    cells.insert(cells.end(), others.begin(), others.end());
    result.add(cells);
  }
  return result;
}

}  // namespace nysalt::bench
