// SPDX-License-Identifier: BSL-1.0
#include "ranking.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "nysalt/analysis/pareto_front.hpp"

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
    case mark::diverged:
      return "some trajectories diverged; of the others alone, and not ranked";
  }
  return {};
}

const backdrop& behind(const comparison& all, std::size_t m, const row& its) {
  static const backdrop none;
  const auto at = all.behind().find({m, its.step});
  return at == all.behind().end() ? none : at->second;
}

namespace {

bool is_better(const asked_metric& metric, const finding& a, const finding& b) {
  return metric.is_acceptance() ? a.value.mean > b.value.mean : a.value.mean < b.value.mean;
}

}  // namespace

std::vector<mark> marks_of(const comparison& all, std::size_t m, const row& its) {
  std::vector<mark> result;
  const finding& one = its.findings[m];
  if (!one.reason.empty() || std::isnan(one.value.mean)) return result;
  const backdrop& against = behind(all, m, its);
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
  if (against.predictable_until.value_or(std::numeric_limits<double>::infinity()) < all.command().horizon) {
    result.push_back(mark::horizon);
  }
  if (one.diverged > 0 && !metric.is_acceptance()) result.push_back(mark::diverged);
  return result;
}

bool is_known(const comparison& all, std::size_t m, const row& its) {
  const finding& one = its.findings[m];
  if (!one.reason.empty() || std::isnan(one.value.mean)) return false;
  const auto marks = marks_of(all, m, its);
  return std::ranges::none_of(marks, [](mark found) {
    return found == mark::reference || found == mark::horizon || found == mark::diverged;
  });
}

bool is_ranked(const comparison& all, std::size_t m, const row& its) {
  return is_known(all, m, its) && std::ranges::count(marks_of(all, m, its), mark::null) == 0;
}

std::vector<at_equal_cost> side_by_side(const comparison& all, std::size_t m) {
  std::vector<at_equal_cost> result;
  constexpr double start_up = 1.01;  // a run of n steps may cost one evaluation more
  for (const row& its : all.rows()) {
    if (!its.is_learned || !is_ranked(all, m, its)) continue;
    const row* best = nullptr;
    for (const row& other : all.rows()) {
      if (other.is_learned || !is_ranked(all, m, other)) continue;
      const bool is_affordable = all.command().equal_cost
                                     ? other.nominal == its.nominal
                                     : other.evaluations_per_time <= start_up * its.evaluations_per_time;
      if (!is_affordable) continue;
      if (best == nullptr || is_better(all.metrics()[m], other.findings[m], best->findings[m])) best = &other;
    }
    if (best != nullptr) result.push_back({&its, best});
  }
  return result;
}

estimate gain(const comparison& all, std::size_t m, const at_equal_cost& pair) {
  estimate learned = pair.learned->findings[m].value;
  estimate best = pair.best->findings[m].value;
  if (all.metrics()[m].is_acceptance()) {
    learned.mean = 1.0 - learned.mean;
    best.mean = 1.0 - best.mean;
  }
  if (learned.mean == 0.0 || best.mean == 0.0) return {};
  const double ratio = best.mean / learned.mean;
  return {ratio, ratio * std::hypot(best.standard_error / best.mean, learned.standard_error / learned.mean)};
}

double evaluations_of(const row& its) { return its.evaluations_per_time; }
double seconds_of(const row& its) { return its.seconds_per_time.least; }

namespace {
/// Of acceptances what is rejected.
double error_of(const comparison& all, std::size_t m, const row& its) {
  const double value = its.findings[m].value.mean;
  return all.metrics()[m].is_acceptance() ? 1.0 - value : value;
}
}  // namespace

std::vector<const row*> pareto_front(const comparison& all, std::size_t m, double (*cost)(const row&)) {
  std::vector<const row*> ranked;
  std::vector<cost_and_error> points;
  for (const row& its : all.rows()) {
    if (!is_ranked(all, m, its)) continue;
    ranked.push_back(&its);
    points.push_back({cost(its), std::max(error_of(all, m, its), behind(all, m, its).floor.value_or(0.0))});
  }
  std::vector<const row*> front;
  for (const std::size_t i : nysalt::pareto_front(points)) front.push_back(ranked[i]);
  return front;
}

namespace {

/// A row that diverged is above any level. Nothing is said of what was not used, nor beyond the horizon.
std::vector<error_at> errors_at(const comparison& all, std::size_t m, const std::string& method,
                                double (*cost)(const row&)) {
  std::vector<error_at> result;
  for (const row& its : all.rows()) {
    if (its.method != method) continue;
    const finding& one = its.findings[m];
    const bool counts = is_known(all, m, its);
    const bool is_lost = one.diverged > 0;
    if (!counts && !is_lost) continue;
    const double error = counts ? error_of(all, m, its) : std::numeric_limits<double>::infinity();
    result.push_back({cost(its), error, one.value.standard_error});
  }
  std::ranges::sort(result, std::greater{}, &error_at::x);
  // Not that of std::ranges: clang++ 14 does not compile what it returns.
  const auto same = [](const error_at& a, const error_at& b) { return a.x == b.x; };
  result.erase(std::unique(result.begin(), result.end(), same), result.end());
  return result;
}

}  // namespace

std::vector<cost_at_level> costs_at(const comparison& all, std::size_t m, double level) {
  constexpr double same_trajectories = 1.0;  // errors of rows rise and fall together: never too small
  std::vector<cost_at_level> result;
  for (const auto& method : all.command().methods) {
    const auto evaluations = errors_at(all, m, method, evaluations_of);
    const auto seconds = errors_at(all, m, method, seconds_of);
    if (evaluations.empty()) continue;
    const auto its = std::ranges::find(all.rows(), method, &row::method);
    result.push_back({.method = method,
                      .is_learned = its->is_learned,
                      .evaluations = threshold(evaluations, level, same_trajectories),
                      .seconds = threshold(seconds, level, same_trajectories)});
  }
  const auto order = [](const cost_at_level& its) {
    return std::pair(its.evaluations.kind == crossing_kind::above_from_first, its.evaluations.x);
  };
  std::ranges::stable_sort(result, {}, order);
  return result;
}

std::vector<std::string> warnings_of_reference(const comparison& all) {
  std::vector<std::string> result;
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    if (all.metrics()[m].is_of_law()) continue;
    std::vector<const row*> rows;
    for (const row& its : all.rows()) {
      if (std::ranges::count(marks_of(all, m, its), mark::reference) > 0) rows.push_back(&its);
    }
    if (rows.empty()) continue;
    const row& first = *rows.front();
    result.push_back(fmt::format(
        "the reference's own error {:.1e} is not ten times smaller than that of {} at step {:g}, {:.1e}{}",
        *behind(all, m, first).reference_error, first.method, first.nominal, first.findings[m].value.mean,
        rows.size() == 1 ? "" : fmt::format(", and so in {} more rows", rows.size() - 1)));
  }
  return result;
}

}  // namespace nysalt::program
