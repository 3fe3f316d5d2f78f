// SPDX-License-Identifier: BSL-1.0
#include "langevin_statistics.hpp"

#include <cmath>
#include <stdexcept>

namespace nysalt::program::paper {

statistics_plan plan_of_statistics(const setting& setup, double step, role whose, int ensemble) {
  const auto count = setup.pick<std::int64_t>(10'000, 32);
  const double horizon = setup.pick(40.0, 4.0);
  return {.trajectories = {step, static_cast<std::int64_t>(horizon / step + 1e-9), count,
                           seed_for(whose, setup.seed()), setup.common.execution.threads},
          .first = ensemble * count};
}

std::vector<named_curve> empty_curves(const std::vector<double>& gaps) {
  return {{"BAOAB", {gaps, {}}}, {"BAOAB with half steps", {gaps, {}}}, {"NySALT", {gaps, {}}}};
}

std::vector<method> methods_at(const setting& setup, const std::string& start, double gap) {
  const prepared_problem& system = setup.in_bath(start);
  return {classical("baoab", system), classical("baoab_2x", system),
          setup.learned_in_bath(start, gap, placement::end)};
}

estimate at_gap(const error_curve& curve, double gap) {
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    if (curve.at[i] == gap) return curve.errors[i];
  }
  throw std::logic_error("a curve must hold the gap");
}

table table_of_laws(const std::vector<named_curve>& methods, double floor) {
  std::vector<std::string> columns{"gap"};
  for (const auto& one : methods) columns.push_back(one.name);
  columns.emplace_back("floor");
  table rows(columns, 0);
  const auto& gaps = methods.front().curve.at;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    std::vector<std::string> cells{fmt::format("{:g}", gaps[i])};
    for (const auto& one : methods) {
      const double value = one.curve.errors[i].mean;
      cells.push_back(std::isfinite(value) ? fmt::format("{:.4f}", value) : "diverges");
    }
    cells.push_back(fmt::format("{:.4f}", floor));
    rows.add(cells);
  }
  return rows;
}

panel panel_of_laws(const std::vector<named_curve>& methods, const std::string& title,
                    const std::string& label, double floor) {
  panel result{title, "gap", label, true, {}};
  for (const auto& [name, errors] : methods) {
    result.curves.push_back({name, errors.at, errors.means(), {}, name == "NySALT"});
  }
  const auto& gaps = methods.front().curve.at;
  result.curves.push_back({"sampling floor", gaps, std::vector<double>(gaps.size(), floor)});
  return result;
}

}  // namespace nysalt::program::paper
