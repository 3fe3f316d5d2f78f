// SPDX-License-Identifier: BSL-1.0
#include "ranking.hpp"

#include <algorithm>
#include <cmath>

#include "nysalt/analysis/pareto_front.hpp"

namespace nysalt::program {

std::string to_string(mark which) {
  switch (which) {
    case mark::reference: return "reference";
    case mark::null: return "null";
    case mark::floor: return "floor";
    case mark::horizon: return "horizon";
    case mark::diverged: return "diverged";
  }
  return {};
}

std::string meaning(mark which) {
  switch (which) {
    case mark::reference: return "the reference's own error is more than a tenth of this one";
    case mark::null: return "no better than the null model, which stays as it was at the start";
    case mark::floor: return "not above the floor of sampling by two standard errors: nothing is seen of the method";
    case mark::horizon:
      return "beyond the time for which a path can be followed: it says more of chaos than of the method, and "
             "is not ranked";
    case mark::diverged: return "some trajectories diverged; of the others alone, and not ranked";
  }
  return {};
}

namespace {

const backdrop& behind(const comparison& all, std::size_t m, const row& its) {
  static const backdrop none;
  const auto at = all.behind().find({m, its.step});
  return at == all.behind().end() ? none : at->second;
}

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
  if (metric.is_along_paths() && against.reference_error.value_or(0.0) > known_well * error) {
    result.push_back(mark::reference);
  }
  if (against.null_model && error >= *against.null_model) result.push_back(mark::null);
  if (against.floor) {
    const double scatter = std::isnan(one.value.standard_error) ? 0.0 : one.value.standard_error;
    if (error <= *against.floor + 2.0 * scatter) result.push_back(mark::floor);
  }
  if (against.predictable_until.value_or(std::numeric_limits<double>::infinity()) < all.command().horizon) {
    result.push_back(mark::horizon);
  }
  if (one.diverged > 0) result.push_back(mark::diverged);
  return result;
}

bool is_ranked(const comparison& all, std::size_t m, const row& its) {
  const finding& one = its.findings[m];
  if (!one.reason.empty() || std::isnan(one.value.mean)) return false;
  return std::ranges::none_of(marks_of(all, m, its),
                              [](mark its) { return its == mark::horizon || its == mark::diverged; });
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

double gain(const comparison& all, std::size_t m, const at_equal_cost& pair) {
  const double learned = pair.learned->findings[m].value.mean;
  const double best = pair.best->findings[m].value.mean;
  return all.metrics()[m].is_acceptance() ? (1.0 - best) / (1.0 - learned) : best / learned;
}

double evaluations_of(const row& its) { return its.evaluations_per_time; }
double seconds_of(const row& its) { return its.seconds_per_time.least; }

std::vector<std::string> warnings_of_reference(const comparison& all) {
  std::vector<std::string> result;
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    for (const row& its : all.rows()) {
      const auto marks = marks_of(all, m, its);
      if (std::ranges::count(marks, mark::reference) == 0) continue;
      result.push_back(fmt::format(
          "the reference's own error {:.1e} is not ten times smaller than that of {} at step {:g}, {:.1e}",
          *behind(all, m, its).reference_error, its.method, its.nominal, its.findings[m].value.mean));
    }
  }
  return result;
}

}  // namespace nysalt::program
