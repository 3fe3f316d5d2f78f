// SPDX-License-Identifier: BSL-1.0
#include "ranking.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "nysalt/analysis/cost_against_error.hpp"

namespace nysalt::program {

std::string to_string(mark which) {
  switch (which) {
    case mark::reference:
      return "reference";
    case mark::null:
      return "null";
    case mark::floor:
      return "floor";
    case mark::horizon:
      return "horizon";
    case mark::tail:
      return "tail";
    case mark::formula:
      return "formula";
    case mark::processed:
      return "processed";
    case mark::edge:
      return "edge";
    case mark::loses:
      return "loses";
    case mark::volume:
      return "volume";
    case mark::diverged:
      return "diverged";
  }
  return {};
}

std::string meaning(mark which) {
  switch (which) {
    case mark::reference:
      return "the reference's own error is more than a tenth of this one, or three times the floor; not "
             "ranked";
    case mark::null:
      return "no better than the null model, which stays as it was at the start and costs nothing; not "
             "ranked";
    case mark::floor:
      return "not above the floor of sampling by two standard errors: nothing is seen of the method";
    case mark::horizon:
      return "beyond the time for which a path can be followed: chaos more than the method; not ranked";
    case mark::tail:
      return "few trajectories decide the mean: it and its standard error say little; ranked by the median, "
             "as are all rows here";
    case mark::formula:
      return "learned, but nothing was gained: a classical method of the same cost, named with the fit, has "
             "as small a loss";
    case mark::processed:
      return "the evaluations are those of one observation of each trajectory, at the end; every further "
             "observation takes one for each pair of letters of the processor";
    case mark::volume:
      return "the method keeps volume and is reversible, but it is not symplectic: it is for sampling, and "
             "nothing bounds its energy over long runs";
    case mark::edge:
      return "the method at this step is near an edge: the judgement in the data says which";
    case mark::loses:
      return "the method loses trajectories in long runs at this step; the value is not ranked";
    case mark::diverged:
      return "some trajectories diverged; the value is of the others only, and is not ranked";
  }
  return {};
}

const baseline& baseline_of(const comparison& all, std::size_t m, const row& line) {
  static const baseline none;
  const auto at = all.measured_baselines().find({m, line.step});
  return at == all.measured_baselines().end() ? none : at->second;
}

namespace {

bool has_tail(const measurement& one) { return one.spread && one.spread->largest.is_heavy(); }

/// Of acceptances what is rejected.
double error_of(const comparison& all, std::size_t m, const row& line) {
  const double value = ranked_value(all, m, line).mean;
  return all.metrics()[m].is_acceptance() ? 1.0 - value : value;
}

ranked_method ranked_method_of(const comparison& all, std::size_t m, const row& line) {
  ranked_method result{.method = line.method,
                       .step = line.nominal,
                       .cost = line.evaluations_per_time,
                       .error = error_of(all, m, line),
                       .standard_error = ranked_value(all, m, line).standard_error};
  if (!is_by_median(all, m)) result.groups = line.measurements[m].groups;
  return result;
}

/// A run of a few steps may cost one evaluation more than another of the same step.
void merge_costs_of_steps(std::vector<ranked_method>& ranked, double tolerance, double evaluation) {
  std::map<double, std::vector<std::size_t>> by_step;
  for (std::size_t i = 0; i < ranked.size(); ++i) by_step[ranked[i].step].push_back(i);
  for (const auto& [step, rows] : by_step) {
    std::vector<double> costs;
    for (const std::size_t i : rows) costs.push_back(ranked[i].cost);
    const auto merged = without_start_up(costs, tolerance, evaluation);
    for (std::size_t k = 0; k < rows.size(); ++k) ranked[rows[k]].cost = merged[k];
  }
}

}  // namespace

bool is_by_median(const comparison& all, std::size_t m) {
  return std::ranges::any_of(
      all.rows(), [&](const row& line) { return has_tail(line.measurements[m]) && is_known(all, m, line); });
}

estimate ranked_value(const comparison& all, std::size_t m, const row& line) {
  const measurement& one = line.measurements[m];
  return one.spread && is_by_median(all, m) ? one.spread->median : one.value;
}

std::vector<mark> marks_of(const comparison& all, std::size_t m, const row& line) {
  std::vector<mark> result;
  const measurement& one = line.measurements[m];
  if (!one.reason.empty() || std::isnan(one.value.mean)) return result;
  const baseline& against = baseline_of(all, m, line);
  const asked_metric& metric = all.metrics()[m];
  const double error = one.value.mean;
  constexpr double known_well = 0.1;
  constexpr double above_floor = 3.0;  // lags are correlated: one distance scatters as much as it is
  const double known = against.reference_error.value_or(0.0);
  if (metric.is_along_paths() && known > known_well * error) result.push_back(mark::reference);
  if (metric.is_of_law() && known > above_floor * against.floor.value_or(known))
    result.push_back(mark::reference);
  if (against.null_model && error >= *against.null_model) result.push_back(mark::null);
  if (against.floor) {
    const double scatter = std::isnan(one.value.standard_error) ? 0.0 : one.value.standard_error;
    if (error <= *against.floor + 2.0 * scatter) result.push_back(mark::floor);
  }
  if (against.predictable_until.value_or(std::numeric_limits<double>::infinity()) < all.horizon()) {
    result.push_back(mark::horizon);
  }
  if (has_tail(one)) result.push_back(mark::tail);
  if (line.gains_nothing) result.push_back(mark::formula);
  if (line.coefficients && line.coefficients->letters().is_processed()) result.push_back(mark::processed);
  if (line.coefficients && !line.coefficients->letters().is_symplectic && !metric.is_acceptance()) {
    result.push_back(mark::volume);
  }
  if (line.judged && !metric.is_acceptance()) {
    if (line.judged->verdict == step_verdict::near_an_edge) result.push_back(mark::edge);
    if (!line.judged->holds() && line.judged->verdict != step_verdict::not_tried)
      result.push_back(mark::loses);
  }
  if (one.diverged > 0 && !metric.is_acceptance()) result.push_back(mark::diverged);
  return result;
}

bool is_known(const comparison& all, std::size_t m, const row& line) {
  const measurement& one = line.measurements[m];
  if (!one.reason.empty() || std::isnan(one.value.mean)) return false;
  const auto marks = marks_of(all, m, line);
  return std::ranges::none_of(marks, [](mark found) {
    return found == mark::reference || found == mark::horizon || found == mark::loses ||
           found == mark::diverged;
  });
}

bool is_ranked(const comparison& all, std::size_t m, const row& line) {
  return is_known(all, m, line) && std::ranges::count(marks_of(all, m, line), mark::null) == 0;
}

std::vector<at_equal_cost> side_by_side(const comparison& all, std::size_t m) {
  std::vector<at_equal_cost> result;
  constexpr double start_up = 1.01;  // a run of n steps may cost one evaluation more
  for (const row& line : all.rows()) {
    if (!line.is_learned || !is_ranked(all, m, line)) continue;
    const row* best = nullptr;
    for (const row& other : all.rows()) {
      if (other.is_learned || !is_ranked(all, m, other)) continue;
      const bool is_affordable = all.options().equal_cost
                                     ? other.nominal == line.nominal
                                     : other.evaluations_per_time <= start_up * line.evaluations_per_time;
      if (!is_affordable) continue;
      if (best == nullptr || error_of(all, m, other) < error_of(all, m, *best)) best = &other;
    }
    if (best != nullptr) result.push_back({&line, best});
  }
  return result;
}

estimate gain(const comparison& all, std::size_t m, const at_equal_cost& pair) {
  return error_ratio(ranked_method_of(all, m, *pair.best), ranked_method_of(all, m, *pair.learned));
}

double evaluations_of(const row& line) { return line.evaluations_per_time; }
double seconds_of(const row& line) { return line.seconds_per_time.least; }

std::vector<const row*> pareto_front(const comparison& all, std::size_t m, double (*cost)(const row&)) {
  std::vector<const row*> ranked;
  std::vector<cost_and_error> points;
  for (const row& line : all.rows()) {
    if (!is_ranked(all, m, line)) continue;
    ranked.push_back(&line);
    points.push_back(
        {cost(line), std::max(error_of(all, m, line), baseline_of(all, m, line).floor.value_or(0.0))});
  }
  std::vector<const row*> front;
  for (const std::size_t i : nysalt::pareto_front(points)) front.push_back(ranked[i]);
  return front;
}

std::vector<best_at_cost> best_by(const comparison& all, std::size_t m, double (*cost)(const row&)) {
  const bool is_by_step = all.options().equal_cost && cost == evaluations_of;
  std::vector<ranked_method> ranked;
  for (const row& line : all.rows()) {
    ranked_method one = ranked_method_of(all, m, line);
    one.error = is_ranked(all, m, line) ? std::max(one.error, baseline_of(all, m, line).floor.value_or(0.0))
                                        : std::numeric_limits<double>::quiet_NaN();
    one.cost = cost(line);
    ranked.push_back(one);
  }
  constexpr double of_counts = 1.01;  // the evaluation of the start
  constexpr double of_times = 1.05;   // by which times of rounds differ
  if (is_by_step) merge_costs_of_steps(ranked, of_counts, 1.0 / all.horizon());
  return best_at_costs(ranked, cost == evaluations_of ? of_counts : of_times);
}

namespace {

/// A row that diverged is above any level. Nothing is said of what was not used, nor beyond the horizon.
std::vector<error_at> errors_at(const comparison& all, std::size_t m, const std::string& method,
                                double (*cost)(const row&)) {
  std::vector<error_at> result;
  for (const row& line : all.rows()) {
    if (line.method != method) continue;
    const measurement& one = line.measurements[m];
    const bool counts = is_known(all, m, line);
    const bool is_lost = one.diverged > 0;
    if (!counts && !is_lost) continue;
    const double error = counts ? error_of(all, m, line) : std::numeric_limits<double>::infinity();
    result.push_back({cost(line), error, ranked_value(all, m, line).standard_error});
  }
  std::ranges::sort(result, std::greater{}, &error_at::x);
  // Not std::ranges::unique: clang++ 14 does not compile what it returns.
  const auto same = [](const error_at& a, const error_at& b) { return a.x == b.x; };
  result.erase(std::unique(result.begin(), result.end(), same), result.end());
  return result;
}

}  // namespace

std::vector<double> levels_for(const comparison& all, std::size_t m) {
  if (!all.options().levels.empty()) return all.options().levels;
  std::vector<std::vector<error_at>> by_method;
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const auto& method : all.options().methods) {
    by_method.push_back(errors_at(all, m, method, evaluations_of));
    for (const error_at& one : by_method.back()) {
      if (!(one.error > 0.0) || std::isinf(one.error)) continue;
      low = std::min(low, one.error);
      high = std::max(high, one.error);
    }
  }
  if (high == 0.0) return {};  // no row has an error, and `low` no logarithm
  std::size_t most = 0;
  std::vector<double> best;
  for (int decade = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, decade) <= high; ++decade) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double level = digit * std::pow(10.0, decade);
      const auto crossing = static_cast<std::size_t>(std::ranges::count_if(by_method, [&](const auto& rows) {
        return !rows.empty() && threshold(rows, level).kind == threshold_crossing::crossing_kind::found;
      }));
      if (crossing > most) best.clear();
      most = std::max(most, crossing);
      if (most > 0 && crossing == most) best.push_back(level);
    }
  }
  if (best.empty()) return {};
  return {best[best.size() / 2]};
}

std::vector<cost_at_level> costs_at(const comparison& all, std::size_t m, double level) {
  constexpr double same_trajectories = 1.0;  // errors of rows rise and fall together: never too small
  std::vector<cost_at_level> result;
  for (const auto& method : all.options().methods) {
    const auto evaluations = errors_at(all, m, method, evaluations_of);
    const auto seconds = errors_at(all, m, method, seconds_of);
    if (evaluations.empty()) continue;
    const auto line = std::ranges::find(all.rows(), method, &row::method);
    result.push_back({.method = method,
                      .is_learned = line->is_learned,
                      .evaluations = threshold(evaluations, level, same_trajectories),
                      .seconds = threshold(seconds, level, same_trajectories)});
  }
  const auto order = [](const cost_at_level& cost) {
    return std::pair(cost.evaluations.kind == threshold_crossing::crossing_kind::above_from_first,
                     cost.evaluations.x);
  };
  std::ranges::stable_sort(result, {}, order);
  return result;
}

std::vector<std::string> warnings_of_reference(const comparison& all) {
  std::vector<std::string> result;
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    if (all.metrics()[m].is_of_law()) continue;
    std::vector<const row*> rows;
    for (const row& line : all.rows()) {
      if (std::ranges::count(marks_of(all, m, line), mark::reference) > 0) rows.push_back(&line);
    }
    if (rows.empty()) continue;
    const row& first = *rows.front();
    result.push_back(fmt::format(
        "the reference's own error {:.1e} is not ten times smaller than that of {} at step {:g}, {:.1e}{}",
        *baseline_of(all, m, first).reference_error, first.method, first.nominal,
        first.measurements[m].value.mean,
        rows.size() == 1 ? "" : fmt::format(", and so in {} more rows", rows.size() - 1)));
  }
  return result;
}

}  // namespace nysalt::program
