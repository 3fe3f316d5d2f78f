// SPDX-License-Identifier: BSL-1.0
// The results of a comparison for machines: a JSON document, and a table of comma-separated values.
#include <fmt/format.h>

#include <cmath>

#include "comparison/judging.hpp"
#include "comparison_report.hpp"
#include "comparison_tables.hpp"

namespace nysalt::program {

namespace {

std::string in_full(double x) { return std::isnan(x) ? std::string() : fmt::format("{}", x); }
std::string in_full(const std::optional<double>& x) { return x ? in_full(*x) : std::string(); }

json number(const std::optional<double>& x) { return x && std::isfinite(*x) ? json(*x) : json(nullptr); }

json row_json(const comparison& all, std::size_t m, const row& line) {
  const asked_metric& metric = all.metrics()[m];
  const measurement& one = line.measurements[m];
  const baseline& against = baseline_of(all, m, line);
  json marks = json::array();
  for (const mark found : marks_of(all, m, line)) marks.push_back(to_string(found));
  json result{{"metric", metric.text()},
              {"method", line.method},
              {"step", line.nominal},
              {"step_size", line.step},
              {"evaluations_per_time", line.evaluations_per_time},
              {"seconds_per_time", line.seconds_per_time.least},
              {"seconds_per_time_median", line.seconds_per_time.median},
              {metric.value(), one.value.mean},
              {"standard_error", one.value.standard_error},
              {"survivors", all.options().trajectories - one.diverged},
              {"diverged", one.diverged},
              {"diverged_at", to_json(one.diverged_at)},
              {"judgement", line.judged ? to_json(*line.judged) : json(nullptr)},
              {"reference_error", metric.is_of_law() ? json(nullptr) : number(against.reference_error)},
              {"marks", marks}};
  if (line.frequency)
    result["frequency"] = {{"value", line.frequency->value}, {"source", line.frequency->source}};
  if (!one.reason.empty()) result["reason"] = one.reason;
  if (one.spread) {
    json quantiles = json::object();
    for (std::size_t i = 0; i < detail::shown_quantiles.size(); ++i) {
      quantiles[fmt::format("{:g} %", 100.0 * detail::shown_quantiles[i])] = number(one.spread->quantiles[i]);
    }
    result["median"] = number(one.spread->median.mean);
    result["median_standard_error"] = number(one.spread->median.standard_error);
    result["quantiles"] = quantiles;
    result["deciding"] = number(one.spread->largest.deciding);
    result["enough_trajectories"] = number(one.spread->largest.enough());
  }
  if (!metric.is_of_law() || !one.law) return result;
  if (against.floor) result["floor"] = *against.floor;
  result["mean"] = one.law->mean.mean;
  result["mean_standard_error"] = one.law->mean.standard_error;
  result["effective_sample_size"] = one.law->effective_sample_size;
  if (!one.law->kinetic_temperature) return result;
  result["kinetic_temperature"] = *one.law->kinetic_temperature;
  result["half_step_kinetic_temperature"] = *one.law->half_step_kinetic_temperature;
  return result;
}

json references_json(const comparison& all) {
  json result = json::array();
  for (const auto& [key, context] : all.measured_baselines()) {
    if (context.reference.empty()) continue;
    json one{{"metric", all.metrics()[key.first].text()},
             {"step_size", key.second},
             {"reference", context.reference},
             {"error", number(context.reference_error)},
             {"null_model", number(context.null_model)}};
    if (context.predictable_until) one["predictable_until"] = number(context.predictable_until);
    if (context.floor) one["floor"] = *context.floor;
    if (context.law) one["mean"] = context.law->mean.mean;
    if (context.law && context.law->kinetic_temperature) {
      one["kinetic_temperature"] = *context.law->kinetic_temperature;
      one["half_step_kinetic_temperature"] = *context.law->half_step_kinetic_temperature;
    }
    result.push_back(one);
  }
  return result;
}

json crossing_json(const threshold_crossing& crossing) {
  constexpr std::array kinds{"found", "bracketed", "below all", "above from first"};
  return {{"kind", kinds[static_cast<std::size_t>(crossing.kind)]},
          {"at", crossing.x},
          {"standard_error", number(crossing.standard_error)}};
}

json best_json(const comparison& all, std::size_t m) {
  json result = json::array();
  for (const best_at_cost& one : best_by(all, m, evaluations_of)) {
    const auto named_at = [](const ranked_method& method) {
      return json{{"method", method.method}, {"step", method.step}};
    };
    json best = json::array();
    for (const ranked_method& method : one.best) best.push_back(named_at(method));
    json at{{"evaluations_per_time", one.cost},
            {"best", best},
            {"next", nullptr},
            {"ratio", nullptr},
            {"standard_error", nullptr}};
    if (one.next) {
      const estimate ratio = error_ratio(*one.next, one.best.front());
      at["next"] = named_at(*one.next);
      at["ratio"] = number(ratio.mean);
      at["standard_error"] = number(ratio.standard_error);
    }
    result.push_back(at);
  }
  return result;
}

json rankings_json(const comparison& all) {
  json result = json::array();
  const auto named = [](const std::vector<const row*>& rows) {
    json names = json::array();
    for (const row* line : rows) names.push_back({{"method", line->method}, {"step", line->nominal}});
    return names;
  };
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    json levels = json::array();
    for (const double level : levels_for(all, m)) {
      if (all.metrics()[m].is_acceptance()) break;
      json costs = json::array();
      for (const cost_at_level& cost : costs_at(all, m, level)) {
        costs.push_back({{"method", cost.method},
                         {"evaluations_per_time", crossing_json(cost.evaluations)},
                         {"seconds_per_time", crossing_json(cost.seconds)}});
      }
      levels.push_back({{"level", level}, {"methods", costs}});
    }
    result.push_back({{"metric", all.metrics()[m].text()},
                      {"ranked_by", is_by_median(all, m) ? "median" : "mean"},
                      {"verdict", plain_verdict(all, m)},
                      {"best_at_costs", best_json(all, m)},
                      {"front_by_evaluations", named(pareto_front(all, m, evaluations_of))},
                      {"front_by_seconds", named(pareto_front(all, m, seconds_of))},
                      {"levels", levels}});
  }
  return result;
}

}  // namespace

json document_of(const comparison& all) {
  const comparison_options& options = all.options();
  json metrics = json::array();
  json rows = json::array();
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    metrics.push_back(all.metrics()[m].text());
    for (const row& line : all.rows()) rows.push_back(row_json(all, m, line));
  }
  json fits = json::array();
  for (const learned_row& fit : all.fits()) fits.push_back(fit.document);
  json left_out = json::array();
  for (const auto& [name, reason] : all.left_out())
    left_out.push_back({{"method", name}, {"reason", reason}});
  const std::string& purpose = options.learning.purpose;
  json result{{"system", all.system().description()},
              {"starts", all.system().starts()},
              {"metrics", metrics},
              {"horizon", all.horizon()},
              {"trajectories", options.trajectories},
              {"equal_cost", options.equal_cost},
              {"seed", all.common().seed},
              {"purpose", purpose.empty() ? json(nullptr) : json(purpose)},
              {"references", references_json(all)},
              {"rows", rows},
              {"rankings", rankings_json(all)},
              {"fits", fits},
              {"left_out", left_out},
              {"warnings", all.warnings()},
              {"peak_memory", peak_memory()}};
  if (!options.prices.empty()) result["prices"] = options.prices;
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    const auto& bins = all.bins(m);
    if (bins) result["histogram"] = {{"low", bins->low}, {"high", bins->high}, {"bins", bins->count}};
    if (all.metrics()[m].is_acceptance()) result["hmc_temperature"] = options.hmc_temperature;
    if (all.metrics()[m].name == "acf") result["longest_lag"] = options.longest_lag;
  }
  return result;
}

std::string csv_of(const comparison& all) {
  table result({"metric",
                "method",
                "step",
                "step_size",
                "evaluations_per_time",
                "seconds_per_time",
                "seconds_per_time_median",
                "value",
                "standard_error",
                "diverged",
                "reference_error",
                "null_model",
                "floor",
                "predictable_until",
                "marks",
                "reason",
                "survivors",
                "quantile_5",
                "quantile_25",
                "median",
                "quantile_75",
                "quantile_95",
                "median_standard_error",
                "deciding",
                "enough_trajectories",
                "verdict"});
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    for (const row& line : all.rows()) {
      const measurement& one = line.measurements[m];
      const baseline& against = baseline_of(all, m, line);
      const method_error::distribution spread = spread_of(one);
      const auto& quantiles = spread.quantiles;
      result.add({all.metrics()[m].text(),
                  line.method,
                  in_full(line.nominal),
                  in_full(line.step),
                  in_full(line.evaluations_per_time),
                  in_full(line.seconds_per_time.least),
                  in_full(line.seconds_per_time.median),
                  in_full(one.value.mean),
                  in_full(one.value.standard_error),
                  fmt::format("{}", one.diverged),
                  all.metrics()[m].is_of_law() ? std::string() : in_full(against.reference_error),
                  in_full(against.null_model),
                  in_full(against.floor),
                  in_full(against.predictable_until),
                  joined_marks(all, m, line),
                  one.reason,
                  fmt::format("{}", all.options().trajectories - one.diverged),
                  in_full(quantiles[0]),
                  in_full(quantiles[1]),
                  in_full(quantiles[2]),
                  in_full(quantiles[3]),
                  in_full(quantiles[4]),
                  in_full(spread.median.standard_error),
                  in_full(spread.largest.deciding),
                  one.spread ? in_full(spread.largest.enough()) : std::string(),
                  line.judged ? std::string(to_string(line.judged->verdict)) : std::string()});
    }
  }
  return result.csv();
}

}  // namespace nysalt::program
