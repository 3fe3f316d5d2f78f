// SPDX-License-Identifier: BSL-1.0
#include "measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nysalt::program {

namespace {

/// What is read may have been edited.
void require(bool holds, const char* member) {
  if (!holds) throw std::out_of_range(member);
}

}  // namespace

void require_whole(const drawn_law& law) {
  require(law.x.size() == law.y.size(), "law");
  // That at half a step is not known of every word.
  require(law.kinetic_temperature || !law.half_step_kinetic_temperature, "temperatures");
}

void require_whole(const energy_course& course) {
  require(course.t.size() == course.deviation.size() && course.t.size() == course.surviving.size(), "t");
}

void require_whole(const measurement& outcome) {
  require(!(outcome.value.mean < 0.0), "value");  // an error, an acceptance, or NaN
  require(outcome.diverged >= 0, "diverged");
  require(!outcome.spread || !(outcome.spread->median.mean < 0.0), "median");
}

drawn_law drawn(const gathered_statistics& found) {
  drawn_law result{
      .x = {}, .y = {}, .mean = found.mean, .effective_sample_size = found.effective_sample_size};
  if (found.counted == 0) return result;
  if (found.histogram) {
    const equal_bins bins = found.histogram->bins();
    for (int i = 0; i < bins.count; ++i) result.x.push_back(bins.low + (i + 0.5) * bins.width());
    result.y = found.histogram->density();
    result.kinetic_temperature = found.kinetic_temperature.mean;
    result.half_step_kinetic_temperature = found.half_step_kinetic_temperature.mean;
  }
  if (found.autocovariance) {
    result.y = found.autocovariance->normalised();
    for (std::size_t k = 0; k < result.y.size(); ++k) {
      result.x.push_back(static_cast<double>(k) * found.autocovariance->interval());
    }
  }
  return result;
}

void measurement::lose(const std::vector<diverged_trajectory>& lost, std::int64_t trajectories) {
  constexpr std::size_t enough = 100;
  diverged = std::ssize(lost);
  diverged_at.assign(lost.begin(), lost.begin() + static_cast<std::ptrdiff_t>(std::min(lost.size(), enough)));
  if (diverged < trajectories) return;
  const auto earliest = std::ranges::min(lost, {}, &diverged_trajectory::step);
  reason = fmt::format("every trajectory diverged, the first of them at step {}", earliest.step);
}

method_error::distribution spread_of(const measurement& outcome) {
  if (outcome.spread) return *outcome.spread;
  method_error::distribution none;
  none.quantiles.fill(std::numeric_limits<double>::quiet_NaN());
  none.largest.deciding = std::numeric_limits<double>::quiet_NaN();
  return none;
}

std::vector<double> means_of_groups(const std::vector<double>& of_each) {
  constexpr std::size_t most = 1024;
  const std::size_t size = (of_each.size() + most - 1) / most;
  std::vector<double> result;
  for (std::size_t first = 0; size > 0 && first + size <= of_each.size(); first += size) {
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i) sum += of_each[first + i];
    result.push_back(sum / static_cast<double>(size));
  }
  return result;
}

measurement measurement_from(const json& text, std::int64_t trajectories) {
  auto outcome = from_json<measurement>(text);
  require(outcome.diverged <= trajectories, "diverged");
  return outcome;
}

std::vector<measured> measured_from(const json& text, std::size_t metrics, std::size_t rows,
                                    std::int64_t trajectories) {
  auto all = from_json<std::vector<measured>>(text);
  require(all.size() == metrics, "metrics");
  for (const measured& one : all) {
    require(one.measurements.size() == rows, "measurements");
    for (const measurement& outcome : one.measurements) require(outcome.diverged <= trajectories, "diverged");
  }
  return all;
}

}  // namespace nysalt::program
