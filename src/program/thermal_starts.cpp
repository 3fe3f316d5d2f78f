// SPDX-License-Identifier: BSL-1.0
#include "thermal_starts.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "comparison/number.hpp"
#include "comparison/refusal.hpp"
#include "csv_file.hpp"
#include "nysalt/ensembles/thermal_positions.hpp"

namespace nysalt::program {

namespace {

/// Which column has q1, q2, ...
std::vector<std::size_t> columns_of_positions(const std::string& file, const std::vector<std::string>& names,
                                              Eigen::Index count) {
  std::unordered_map<std::string_view, std::size_t> places;
  for (std::size_t k = 0; k < names.size(); ++k) places.emplace(names[k], k);
  std::vector<std::size_t> columns;
  for (Eigen::Index i = 1; i <= count; ++i) {
    const auto found = places.find(fmt::format("q{}", i));
    if (found == places.end()) {
      refuse("{}: the first line must name the columns q1 to q{}, got no q{}", file, count, i);
    }
    columns.push_back(found->second);
  }
  return columns;
}

}  // namespace

initial_states starts_in(const std::string& file, const model& system, double temperature) {
  std::vector<std::size_t> columns;
  std::vector<vector<double, Eigen::Dynamic>> positions;
  const auto header = [&](const std::vector<std::string>& names) {
    columns = columns_of_positions(file, names, size(system));
  };
  read_csv("--start", file, header, [&](std::size_t number, const std::vector<std::string_view>& cells) {
    vector<double, Eigen::Dynamic> q(size(system));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      q[static_cast<Eigen::Index>(i)] = number_in_cell(
          cells[columns[i]], [&] { return fmt::format("{}: line {}, q{}", file, number, i + 1); });
    }
    positions.push_back(std::move(q));
  });
  try {
    return thermal_positions<Eigen::Dynamic>(system, std::move(positions), temperature);
  } catch (const std::invalid_argument& problem) {
    refuse("cannot take --start {}: {}", file, problem.what());
  }
}

}  // namespace nysalt::program
