// SPDX-License-Identifier: BSL-1.0
#include "thermal_starts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "comparison/number.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/ensembles/thermal_positions.hpp"

namespace nysalt::program {

namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

/// Which column has q1, q2, ...
std::vector<std::size_t> columns_of_positions(const std::string& file, const std::vector<std::string>& names,
                                              Eigen::Index count) {
  std::vector<std::size_t> columns;
  for (Eigen::Index i = 1; i <= count; ++i) {
    const auto found = std::ranges::find(names, fmt::format("q{}", i));
    if (found == names.end()) {
      refuse("{}: its first line must name the columns q1 to q{}, and q{} is not there", file, count, i);
    }
    columns.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  return columns;
}

}  // namespace

initial_states starts_in(const std::string& file, const model& system, double temperature) {
  std::ifstream input(file);
  std::string line;
  if (!input || !std::getline(input, line)) refuse("--start {}: it cannot be read", file);
  const auto columns = columns_of_positions(file, cells_of(line), size(system));
  std::vector<vector<double, Eigen::Dynamic>> positions;
  for (std::size_t number = 2; std::getline(input, line); ++number) {
    if (line.empty()) continue;
    const auto cells = cells_of(line);
    vector<double, Eigen::Dynamic> q(size(system));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i] >= cells.size()) refuse("{}: line {} has {} columns", file, number, cells.size());
      q[static_cast<Eigen::Index>(i)] =
          number_of<double>(fmt::format("{}: line {}, q{}", file, number, i + 1), cells[columns[i]]);
    }
    positions.push_back(std::move(q));
  }
  try {
    return thermal_positions<Eigen::Dynamic>(system, std::move(positions), temperature);
  } catch (const std::invalid_argument& problem) {
    refuse("--start {}: {}", file, problem.what());
  }
}

}  // namespace nysalt::program
