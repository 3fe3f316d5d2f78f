// SPDX-License-Identifier: BSL-1.0
#include "sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nysalt::program::paper {

const error_curve& curve_named(const std::string& name, const std::vector<named_curve>& all) {
  const auto found = std::ranges::find(all, name, &named_curve::name);
  if (found == all.end()) throw std::logic_error(fmt::format("unknown method '{}'", name));
  return found->curve;
}

sweep errors_against_gap(const setting& setup, const prepared_problem& system,
                         const std::vector<rival>& rivals, const std::vector<double>& gaps,
                         const judged& how) {
  sweep all;
  for (const auto& one : rivals) all.methods.push_back({one.name, {gaps, {}}});
  for (const double gap : gaps) {
    const double step = gap * gap_step;
    std::vector<method> methods;
    for (const auto& one : rivals) methods.push_back(one.at(gap));
    const auto found = errors_at(setup, system, methods, step, how);
    all.of_reference.push_back(found.of_reference);
    for (std::size_t k = 0; k < rivals.size(); ++k) {
      all.methods[k].curve.errors.push_back(error_of(found.methods[k]));
    }
  }
  return all;
}

table table_of(const sweep& all) {
  std::vector<std::string> columns{"gap"};
  for (const auto& one : all.methods) columns.push_back(one.name);
  columns.emplace_back("reference's own");
  table rows(columns, 0);
  const auto& gaps = all.methods.front().curve.at;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    std::vector<std::string> cells{fmt::format("{:g}", gaps[i])};
    for (const auto& one : all.methods) {
      const estimate& e = one.curve.errors[i];
      cells.push_back(std::isfinite(e.mean) ? fmt::format("{:.2e} +- {:.0e}", e.mean, e.standard_error)
                                            : "diverges");
    }
    cells.push_back(fmt::format("{:.0e}", all.of_reference[i]));
    rows.add(cells);
  }
  return rows;
}

panel panel_of(const sweep& all, const std::string& title, const std::string& y_label) {
  panel result{title, "gap", y_label, true, {}};
  for (const auto& [name, errors] : all.methods) {
    result.curves.push_back({name, errors.at, errors.means(), errors.bars(), name == "NySALT"});
  }
  return result;
}

double least_ratio(const error_curve& a, const error_curve& b, double most) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.at.size(); ++i) {
    if (a.at[i] <= most) least = std::min(least, b.errors[i].mean / a.errors[i].mean);
  }
  return least;
}

double below_up_to(const error_curve& a, const error_curve& b) {
  double last = 0.0;
  for (std::size_t i = 0; i < a.at.size() && a.errors[i].mean < b.errors[i].mean; ++i) last = a.at[i];
  return last;
}

std::string steps_text(const std::vector<double>& gaps) {
  std::string text;
  for (const double gap : gaps) text += fmt::format("{}{:g}", text.empty() ? "" : ",", gap * gap_step);
  return text;
}

}  // namespace nysalt::program::paper
