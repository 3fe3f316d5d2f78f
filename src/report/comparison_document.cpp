// SPDX-License-Identifier: BSL-1.0
// The results of a comparison for machines: a JSON document, and a table of comma-separated values.
#include <array>
#include <cmath>

#include "comparison_report.hpp"
#include "comparison_tables.hpp"
#include "method_row.hpp"

namespace nysalt::program {

namespace {

method_row row_of(const comparison& all, std::size_t m, const row& line) {
  const asked_metric& metric = all.metrics()[m];
  const measurement& one = line.measurements[m];
  const baseline& against = baseline_of(all, m, line);
  method_row result{.metric = metric.text(),
                    .method = line.method,
                    .step = line.nominal,
                    .step_size = line.step,
                    .evaluations_per_time = line.evaluations_per_time,
                    .seconds_per_time = line.seconds_per_time.least,
                    .seconds_per_time_median = line.seconds_per_time.median,
                    .standard_error = one.value.standard_error,
                    .survivors = all.options().trajectories - one.diverged,
                    .diverged = one.diverged,
                    .diverged_at = one.diverged_at,
                    .reason = one.reason,
                    .learned = line.is_learned,
                    .null_model = against.null_model,
                    .floor = against.floor,
                    .predictable_until = against.predictable_until,
                    .frequency = line.frequency,
                    .judgement = line.judged};
  (metric.is_acceptance() ? result.acceptance : result.error) = one.value.mean;
  for (const mark found : marks_of(all, m, line)) result.marks.push_back(to_string(found));
  if (!metric.is_of_law()) result.reference_error = against.reference_error;
  if (line.coefficients) {
    const nysalt::word& word = line.coefficients->letters();
    result.order = line.coefficients->order;
    result.reversible = line.coefficients->symmetric;
    result.rotation = word.rotates();
    result.evaluations_per_step = word.evaluations_per_step;
  }
  if (one.spread) {
    const auto& at = one.spread->quantiles;
    result.quantile_5 = at[0];
    result.quantile_25 = at[1];
    result.quantile_75 = at[3];
    result.quantile_95 = at[4];
    result.median = one.spread->median.mean;
    result.median_standard_error = one.spread->median.standard_error;
    result.deciding = one.spread->largest.deciding;
    result.enough_trajectories = one.spread->largest.enough();
  }
  if (metric.is_of_law() && one.law) {
    result.mean = one.law->mean.mean;
    result.mean_standard_error = one.law->mean.standard_error;
    result.effective_sample_size = one.law->effective_sample_size;
    result.kinetic_temperature = one.law->kinetic_temperature;
    result.half_step_kinetic_temperature = one.law->half_step_kinetic_temperature;
  }
  return result;
}

std::vector<method_row> all_rows(const comparison& all) {
  std::vector<method_row> result;
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    for (const row& line : all.rows()) result.push_back(row_of(all, m, line));
  }
  return result;
}

/// What the rows of a step are seen against, by a metric.
struct reference_of_rows : baseline {
  std::string metric;
  double step_size;
};

std::vector<reference_of_rows> references_of(const comparison& all) {
  std::vector<reference_of_rows> result;
  for (const auto& [key, context] : all.measured_baselines()) {
    if (!context.reference.empty()) result.push_back({context, all.metrics()[key.first].text(), key.second});
  }
  return result;
}

/// NaN and nothing where it is not compared by.
drawn_law law_of(const baseline& context) { return context.law.value_or(drawn_law()); }

struct ranked_metric {
  const comparison& all;
  std::size_t metric;
};

std::vector<ranked_metric> rankings_of(const comparison& all) {
  std::vector<ranked_metric> result;
  for (std::size_t m = 0; m < all.metrics().size(); ++m) result.push_back({all, m});
  return result;
}

struct costs_at_level {
  double level;
  std::vector<cost_at_level> methods;
};

std::vector<costs_at_level> levels_of(const ranked_metric& one) {
  std::vector<costs_at_level> result;
  if (one.all.metrics()[one.metric].is_acceptance()) return result;
  for (const double level : levels_for(one.all, one.metric))
    result.push_back({level, costs_at(one.all, one.metric, level)});
  return result;
}

struct method_at_step {
  std::string method;
  double step;
};

template <double cost(const row&)>
std::vector<method_at_step> front_of(const ranked_metric& one) {
  std::vector<method_at_step> result;
  for (const row* line : pareto_front(one.all, one.metric, cost))
    result.push_back({line->method, line->nominal});
  return result;
}

estimate next_to_best(const best_at_cost& one) {
  return one.next ? error_ratio(*one.next, one.best.front()) : estimate();
}

template <class Value>
std::optional<Value> where_asked(const comparison& all, const auto& is_asked, const Value& value) {
  return only_if(std::ranges::any_of(all.metrics(), is_asked), value);
}

std::vector<kept<learned_fit>> fits_of(const comparison& all) {
  std::vector<kept<learned_fit>> result;
  for (const learned_row& one : all.fits()) result.push_back(one.fit);
  return result;
}

/// Of each of these fits; null of one that is not usable.
std::vector<json> schemes_of(const comparison& all) {
  std::vector<json> result;
  for (const learned_row& one : all.fits()) result.push_back(one.scheme);
  return result;
}

std::optional<equal_bins> histogram_of(const comparison& all) {
  for (std::size_t m = all.metrics().size(); m-- > 0;) {
    if (all.bins(m)) return all.bins(m);
  }
  return std::nullopt;
}

}  // namespace

constexpr auto members(of<equal_bins>) {
  return std::tuple(NYSALT_MEMBERS(equal_bins, low, high), item{"bins", &equal_bins::count});
}
constexpr auto members(of<reference_of_rows>) {
  using reference = reference_of_rows;
  return std::tuple(
      NYSALT_MEMBERS(reference, metric, step_size, reference), item{"error", &reference::reference_error},
      NYSALT_MEMBERS(reference, null_model, predictable_until, floor),
      item{"mean", [](const reference& one) { return law_of(one).mean.mean; }},
      item{"kinetic_temperature", [](const reference& one) { return law_of(one).kinetic_temperature; }},
      item{"half_step_kinetic_temperature",
           [](const reference& one) { return law_of(one).half_step_kinetic_temperature; }});
}
NYSALT_DESCRIBED(method_at_step, method, step)
NYSALT_DESCRIBED(ranked_method, method, step)
constexpr auto members(of<best_at_cost>) {
  return std::tuple(
      item{"evaluations_per_time", &best_at_cost::cost}, NYSALT_MEMBERS(best_at_cost, best, next),
      item{"ratio", [](const best_at_cost& one) { return next_to_best(one).mean; }},
      item{"standard_error", [](const best_at_cost& one) { return next_to_best(one).standard_error; }});
}
constexpr auto members(of<threshold_crossing>) {
  return std::tuple(item{"kind",
                         [](const threshold_crossing& crossing) {
                           constexpr std::array kinds{"found", "bracketed", "below all", "above from first"};
                           return kinds[static_cast<std::size_t>(crossing.kind)];
                         }},
                    item{"at", &threshold_crossing::x},
                    item{"standard_error", &threshold_crossing::standard_error});
}
constexpr auto members(of<cost_at_level>) {
  return std::tuple(item{"method", &cost_at_level::method},
                    item{"evaluations_per_time", &cost_at_level::evaluations},
                    item{"seconds_per_time", &cost_at_level::seconds});
}
NYSALT_DESCRIBED(costs_at_level, level, methods)
constexpr auto members(of<ranked_metric>) {
  return std::tuple(
      item{"metric", [](const ranked_metric& one) { return one.all.metrics()[one.metric].text(); }},
      item{"ranked_by",
           [](const ranked_metric& one) { return is_by_median(one.all, one.metric) ? "median" : "mean"; }},
      item{"verdict", [](const ranked_metric& one) { return plain_verdict(one.all, one.metric); }},
      item{"best_at_costs",
           [](const ranked_metric& one) { return best_by(one.all, one.metric, evaluations_of); }},
      item{"front_by_evaluations", front_of<evaluations_of>}, item{"front_by_seconds", front_of<seconds_of>},
      item{"levels", levels_of});
}
constexpr auto members(of<comparison>) {
  return std::tuple(item{"system", [](const comparison& all) { return all.system().description(); }},
                    item{"starts", [](const comparison& all) { return all.system().starts(); }},
                    item{"metrics",
                         [](const comparison& all) {
                           std::vector<std::string> texts;
                           for (const asked_metric& metric : all.metrics()) texts.push_back(metric.text());
                           return texts;
                         }},
                    item{"horizon", &comparison::horizon},
                    item{"trajectories", [](const comparison& all) { return all.options().trajectories; }},
                    item{"equal_cost", [](const comparison& all) { return all.options().equal_cost; }},
                    item{"seed", [](const comparison& all) { return all.common().seed; }},
                    item{"purpose", [](const comparison& all) { return all.options().learning.purpose; }},
                    item{"prices", [](const comparison& all) { return all.options().prices; }},
                    item{"histogram", histogram_of},
                    item{"hmc_temperature",
                         [](const comparison& all) {
                           return where_asked(all, &asked_metric::is_acceptance,
                                              all.options().hmc_temperature);
                         }},
                    item{"longest_lag",
                         [](const comparison& all) {
                           return where_asked(
                               all, [](const asked_metric& metric) { return metric.name == "acf"; },
                               all.options().longest_lag);
                         }},
                    item{"references", references_of}, item{"rows", all_rows}, item{"rankings", rankings_of},
                    item{"fits", fits_of}, item{"schemes", schemes_of},
                    item{"left_out", [](const comparison& all) { return left_out_of(all.left_out()); }},
                    NYSALT_MEMBERS(comparison, warnings),
                    item{"peak_memory", [](const comparison&) { return peak_memory(); }});
}

json document_of(const comparison& all) { return whole_document(all); }
json schema_of_comparison() { return whole_schema<comparison>("nysalt compare"); }

std::string csv_of(const comparison& all) {
  const json schema = schema_of<method_row>();
  table result(row_of_table(json(), schema).names);
  for (const method_row& one : all_rows(all)) result.add(row_of_table(as_json(one), schema).cells);
  return result.csv();
}

}  // namespace nysalt::program
