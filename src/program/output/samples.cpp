// SPDX-License-Identifier: BSL-1.0
#include "samples.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <utility>

#include "comparison/number.hpp"
#include "comparison/refusal.hpp"

namespace nysalt::program {

samples::samples(std::vector<std::string> observables, double step, std::int64_t every, sink lines)
    : observables_(std::move(observables)), step_(step), every_(every), lines_(std::move(lines)) {}

void samples::begin() {
  if (lines_) lines_(fmt::format("trajectory,step,t,{}\n", fmt::join(observables_, ",")));
}

json samples::columns() const {
  json all{"trajectory", "step", "t"};
  for (const auto& name : observables_) all.push_back(name);
  return all;
}

void samples::take(std::int64_t trajectory, const record& segment) {
  const std::size_t width = observables_.size();
  for (std::size_t i = 0; i < segment.values.size(); i += width) {
    const std::int64_t n = segment.first + static_cast<std::int64_t>(i / width) * every_;
    add(trajectory, n, std::span(segment.values).subspan(i, width));
  }
  hand_on();
}

void samples::hand_on() {
  if (lines_ && !text_.empty()) lines_(text_);
  text_.clear();
}

void samples::add(std::int64_t trajectory, std::int64_t n, std::span<const double> values) {
  const double t = static_cast<double>(n) * step_;
  if (lines_) {
    text_ += fmt::format("{},{},{}", trajectory, n, t);
    for (const double x : values) text_ += std::isfinite(x) ? fmt::format(",{}", x) : std::string(",");
    text_ += '\n';
    constexpr std::size_t enough = std::size_t{1} << 20U;
    if (text_.size() > enough) hand_on();
  } else {
    json& row = rows_.emplace_back(json{trajectory, n, t});
    for (const double x : values) row.push_back(x);
  }
}

first_trajectory read_first_trajectory(const std::string& table, std::int64_t every,
                                       std::size_t observables) {
  std::ifstream file(table);
  std::string row;
  std::getline(file, row);
  first_trajectory result{{}, std::vector<std::vector<double>>(observables)};
  for (std::int64_t n = 0; std::getline(file, row) && row.starts_with("0,"); ++n) {
    if (n % every != 0) continue;
    std::vector<std::string_view> fields;
    for (std::string_view rest = row;; rest.remove_prefix(fields.back().size() + 1)) {
      fields.push_back(rest.substr(0, rest.find(',')));
      if (fields.back().size() == rest.size()) break;
    }
    const auto number = [&](std::size_t k) {
      const auto value = k < fields.size() ? number_from(fields[k]) : std::nullopt;
      return value.value_or(std::numeric_limits<double>::quiet_NaN());
    };
    result.t.push_back(number(2));
    for (std::size_t k = 0; k < observables; ++k) result.values[k].push_back(number(3 + k));
  }
  if (result.t.empty()) refuse("{} cannot be read again to be drawn", table);
  return result;
}

}  // namespace nysalt::program
