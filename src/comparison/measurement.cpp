// SPDX-License-Identifier: BSL-1.0
#include "measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace nysalt::program {

namespace {

/// JSON has no number that is not finite: null is NaN, a text infinity.
json number(double x) { return std::isinf(x) ? json("infinite") : std::isnan(x) ? json(nullptr) : json(x); }
double double_from(const json& text) {
  if (text.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (text == "infinite") return std::numeric_limits<double>::infinity();
  return text.get<double>();  // throws unless it is one
}

/// What is read may have been edited.
void require(bool holds, const char* member) {
  if (!holds) throw std::out_of_range(member);
}

const json& list_in(const json& text) {
  require(text.is_array(), "list");
  return text;
}

void put(json& into, const char* name, const std::optional<double>& value) {
  if (value) into[name] = number(*value);
}
std::optional<double> taken(const json& from, const char* name) {
  if (!from.contains(name)) return std::nullopt;
  return double_from(from.at(name));
}

json to_json(const estimate& value) { return {number(value.mean), number(value.standard_error)}; }
estimate estimate_from(const json& text) {
  require(list_in(text).size() == 2, "value");
  return {double_from(text[0]), double_from(text[1])};
}

json numbers(const std::vector<double>& all) {
  json result = json::array();
  for (const double x : all) result.push_back(number(x));
  return result;
}
std::vector<double> numbers_from(const json& text) {
  std::vector<double> result;
  for (const auto& x : list_in(text)) result.push_back(double_from(x));
  return result;
}

json to_json(const method_error::distribution& errors) {
  return {{"count", errors.largest.count},
          {"skewness", number(errors.largest.skewness)},
          {"deciding", number(errors.largest.deciding)},
          {"median", to_json(errors.median)},
          {"quantiles", numbers({errors.quantiles.begin(), errors.quantiles.end()})}};
}
method_error::distribution spread_from(const json& text) {
  method_error::distribution errors{.largest = {.count = text.at("count").get<double>(),
                                                .skewness = double_from(text.at("skewness")),
                                                .deciding = double_from(text.at("deciding"))},
                                    .median = estimate_from(text.at("median"))};
  const auto quantiles = numbers_from(text.at("quantiles"));
  require(quantiles.size() == errors.quantiles.size(), "quantiles");
  require(!(errors.median.mean < 0.0), "median");
  std::ranges::copy(quantiles, errors.quantiles.begin());
  return errors;
}

json to_json(const drawn_law& law) {
  json result{{"x", numbers(law.x)},
              {"y", numbers(law.y)},
              {"mean", to_json(law.mean)},
              {"effective_sample_size", number(law.effective_sample_size)}};
  put(result, "kinetic_temperature", law.kinetic_temperature);
  put(result, "half_step_kinetic_temperature", law.half_step_kinetic_temperature);
  return result;
}
drawn_law law_from(const json& text) {
  drawn_law law{.x = numbers_from(text.at("x")),
                .y = numbers_from(text.at("y")),
                .mean = estimate_from(text.at("mean")),
                .effective_sample_size = double_from(text.at("effective_sample_size")),
                .kinetic_temperature = taken(text, "kinetic_temperature"),
                .half_step_kinetic_temperature = taken(text, "half_step_kinetic_temperature")};
  require(law.x.size() == law.y.size(), "law");
  require(law.kinetic_temperature.has_value() == law.half_step_kinetic_temperature.has_value(),
          "temperatures");
  return law;
}

}  // namespace

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

json to_json(const std::vector<diverged_trajectory>& lost) {
  json result = json::array();
  for (const auto& one : lost) result.push_back({{"trajectory", one.trajectory}, {"step", one.step}});
  return result;
}

json to_json(const measurement& outcome) {
  json result{{"value", to_json(outcome.value)},
              {"reason", outcome.reason},
              {"diverged", outcome.diverged},
              {"diverged_at", to_json(outcome.diverged_at)}};
  if (outcome.law) result["law"] = to_json(*outcome.law);
  if (outcome.spread) result["spread"] = to_json(*outcome.spread);
  if (!outcome.groups.empty()) result["groups"] = numbers(outcome.groups);
  return result;
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
  measurement outcome{.value = estimate_from(text.at("value")),
                      .reason = text.at("reason").get<std::string>(),
                      .diverged = text.at("diverged").get<std::int64_t>()};
  require(!(outcome.value.mean < 0.0), "value");  // an error, an acceptance, or NaN
  require(0 <= outcome.diverged && outcome.diverged <= trajectories, "diverged");
  for (const auto& one : list_in(text.at("diverged_at"))) {
    outcome.diverged_at.push_back(
        {one.at("trajectory").get<std::int64_t>(), one.at("step").get<std::int64_t>()});
  }
  if (text.contains("law")) outcome.law = law_from(text.at("law"));
  if (text.contains("spread")) outcome.spread = spread_from(text.at("spread"));
  if (text.contains("groups")) outcome.groups = numbers_from(text.at("groups"));
  return outcome;
}

json to_json(const energy_course& course) {
  return {{"t", numbers(course.t)},
          {"deviation", numbers(course.deviation)},
          {"surviving", numbers(course.surviving)}};
}
energy_course energies_from(const json& text) {
  energy_course course{numbers_from(text.at("t")), numbers_from(text.at("deviation")),
                       numbers_from(text.at("surviving"))};
  require(course.t.size() == course.deviation.size() && course.t.size() == course.surviving.size(), "t");
  return course;
}

json to_json(const baseline& context) {
  json result{{"reference", context.reference}};
  put(result, "reference_error", context.reference_error);
  put(result, "null_model", context.null_model);
  put(result, "predictable_until", context.predictable_until);
  put(result, "floor", context.floor);
  if (context.law) result["law"] = to_json(*context.law);
  return result;
}

baseline baseline_from(const json& text) {
  baseline context{.reference = text.at("reference").get<std::string>(),
                   .reference_error = taken(text, "reference_error"),
                   .null_model = taken(text, "null_model"),
                   .predictable_until = taken(text, "predictable_until"),
                   .floor = taken(text, "floor")};
  if (text.contains("law")) context.law = law_from(text.at("law"));
  return context;
}

json to_json(const measured& all) {
  json measurements = json::array();
  for (const measurement& one : all.measurements) measurements.push_back(to_json(one));
  return {{"behind", to_json(all.against)}, {"findings", measurements}};
}
json to_json(const std::vector<measured>& all) {
  json result = json::array();
  for (const measured& one : all) result.push_back(to_json(one));
  return result;
}
measured measured_from(const json& text, std::size_t rows, std::int64_t trajectories) {
  measured result{.against = baseline_from(text.at("behind"))};
  for (const auto& one : list_in(text.at("findings"))) {
    result.measurements.push_back(measurement_from(one, trajectories));
  }
  require(result.measurements.size() == rows, "findings");
  return result;
}
std::vector<measured> all_measured_from(const json& text, std::size_t metrics, std::size_t rows,
                                        std::int64_t trajectories) {
  std::vector<measured> result;
  for (const auto& one : list_in(text)) result.push_back(measured_from(one, rows, trajectories));
  require(result.size() == metrics, "metrics");
  return result;
}

}  // namespace nysalt::program
