// SPDX-License-Identifier: BSL-1.0
// From several starts to the best minimum that may be used.

#include "search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "describe.hpp"
#include "minimise.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

namespace {

/// Minimises where `defined`; bounds that may be attained are left aside, and where the search ends beyond
/// one that parameter is held there and the others are fitted again.
candidate descend(const search_task& task, const theta_condition& defined, const named_parameters& start) {
  candidate found{.from = start.name, .theta = start.theta, .hessian = {}, .free = task.free};
  for (bool inside = false; !inside;) {
    const auto end = minimise(task.loss, defined, found.theta, found.free, task.max_iterations);
    found.theta = end.theta;
    found.hessian = end.hessian;
    found.loss = end.loss;
    found.converged = end.converged;
    found.in_valley = end.in_valley;
    found.iterations += end.iterations;
    inside = 0 == std::erase_if(found.free, [&](Eigen::Index k) {
               constexpr double met = 1e-12;  // a bound is met to rounding: exact recovery of Verlet
               const auto& [low, high, open] = task.family->ranges[static_cast<std::size_t>(k)];
               double& theta = found.theta[k];
               if (open || (low + met < theta && theta < high - met)) return false;
               theta = theta - low < high - theta ? low : high;
               return true;
             });
  }
  found.judged =
      std::isfinite(found.loss) ? task.judge(found.theta) : std::numeric_limits<double>::infinity();
  found.admitted = task.admits(found.theta);
  return found;
}

/// A parameter is held at the end of all ranges: the data do not determine it, and such a fit is not usable.
bool has_run_away(const candidate& one, const std::vector<Eigen::Index>& free) {
  return std::ranges::any_of(free, [&](Eigen::Index k) {
    return std::ranges::find(one.free, k) == one.free.end() &&
           std::abs(one.theta[k]) == detail::farthest_parameter;
  });
}

/// Those that the judge can judge, from the one that it likes best on; of equals the first comes first. Those
/// that have run away come last.
std::vector<candidate> by_judgement(std::vector<candidate> all, const std::vector<Eigen::Index>& free) {
  std::erase_if(all, [](const candidate& one) { return !std::isfinite(one.judged); });
  std::ranges::stable_sort(all, {}, &candidate::judged);
  // Not std::ranges::stable_partition: clang++ 14 does not compile what it returns.
  std::stable_partition(all.begin(), all.end(),
                        [&](const candidate& one) { return !has_run_away(one, free); });
  return all;
}

/// The first that is admitted and withstands a trial run; nothing if none of the first few different ones
/// does.
std::optional<candidate> first_to_withstand(const search_task& task, const std::vector<candidate>& in_order) {
  constexpr int most_trials = 4;
  constexpr double same = 1e-6;  // of coefficients of order one
  std::vector<Eigen::VectorXd> failed;
  for (const candidate& one : in_order) {
    if (!one.admitted) continue;
    if (!task.withstands) return one;
    const bool has_failed = std::ranges::any_of(
        failed, [&](const Eigen::VectorXd& theta) { return (theta - one.theta).norm() <= same; });
    if (has_failed) continue;
    if (task.withstands(one.theta)) return one;
    failed.push_back(one.theta);
    if (std::ssize(failed) == most_trials) break;
  }
  return std::nullopt;
}

}  // namespace

Eigen::VectorXd random_start(const family& family, Eigen::VectorXd theta,
                             const std::vector<Eigen::Index>& free, std::uint64_t seed, std::uint64_t n) {
  const double deviation = 0.6 * std::exp2(-static_cast<double>(n % 4));
  Eigen::VectorXd normals(theta.size());
  standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::search}, normals);
  const Eigen::VectorXd around = theta;
  for (const Eigen::Index k : free) theta[k] += deviation * normals[k];
  const Eigen::VectorXd moved = inside(family, theta);
  theta = around;
  for (const Eigen::Index k : free) theta[k] = moved[k];
  return theta;
}

Eigen::VectorXd inside(const family& family, Eigen::VectorXd theta) {
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    const auto& [low, high, open] = family.ranges[static_cast<std::size_t>(k)];
    const double inset = open ? 1e-3 * (high - low) : 0.0;
    theta[k] = std::clamp(theta[k], low + inset, high - inset);
  }
  return theta;
}

namespace {

struct start_with_loss {
  named_parameters at;
  double loss;
};

/// The best minima of an earlier loss that differ, those first that the guard admits. Every other two of the
/// searches may climb: they cross the bends of narrow valleys, and the others stay where they begin, so that
/// either find minima that the others miss. And the least loss that was found.
std::pair<std::vector<named_parameters>, double> most_promising(const search_task& task,
                                                                const objective& loss,
                                                                const std::vector<named_parameters>& starts,
                                                                std::size_t most) {
  constexpr double far_apart = 0.05;  // of coefficients of order one
  const auto is_defined = [&](const Eigen::VectorXd& theta) { return task.family->is_defined(theta); };
  std::vector<start_with_loss> all;
  for (std::size_t n = 0; n < starts.size(); ++n) {
    const auto& start = starts[n];
    auto [theta, value] = descend_roughly(loss, is_defined, start.theta, task.free, n / 2 % 2 == 1);
    if (!task.family->is_in_range(theta)) {
      theta = inside(*task.family, std::move(theta));
      value = is_defined(theta) ? loss(theta).value : std::numeric_limits<double>::infinity();
    }
    if (std::isfinite(value)) all.push_back({{start.name, std::move(theta)}, value});
  }
  std::ranges::stable_sort(all, {}, &start_with_loss::loss);
  std::vector<named_parameters> admitted;
  std::vector<named_parameters> others;
  for (const auto& one : all) {
    const named_parameters& at = one.at;
    if (admitted.size() == most) break;
    const auto is_near = [&](const named_parameters& known) {
      return (known.theta - at.theta).norm() <= far_apart;
    };
    if (std::ranges::any_of(admitted, is_near) || std::ranges::any_of(others, is_near)) continue;
    (task.admits(at.theta) ? admitted : others).push_back(at);
  }
  for (const auto& at : others) {
    if (admitted.size() == most) break;
    admitted.push_back(at);
  }
  return {admitted, all.empty() ? std::numeric_limits<double>::infinity() : all.front().loss};
}

/// Of the minima of the one-step loss that the first few starts lead to, the least, and that of the least
/// loss: where errors are tiny one step distinguishes several minima that trajectories see as one narrow
/// valley.
std::vector<named_parameters> one_step_minima(const search_task& task,
                                              const std::vector<named_parameters>& starts) {
  constexpr std::size_t most = 12;
  const auto is_defined = [&](const Eigen::VectorXd& theta) { return task.family->is_defined(theta); };
  struct found {
    named_parameters at;
    double of_one_step = std::numeric_limits<double>::infinity();
    double loss = std::numeric_limits<double>::infinity();
  };
  std::vector<found> all;
  for (std::size_t n = 0; n < std::min(most, starts.size()); ++n) {
    const auto end =
        minimise(task.one_step_loss, is_defined, starts[n].theta, task.free, task.max_iterations);
    if (!std::isfinite(end.loss) || !task.family->is_in_range(end.theta)) continue;
    all.push_back({{"one step", end.theta}, end.loss, task.loss(end.theta).value});
  }
  if (all.empty()) return {};
  const auto least = std::ranges::min_element(all, {}, &found::of_one_step);
  const auto best = std::ranges::min_element(all, {}, &found::loss);
  std::vector<named_parameters> result{least->at};
  if (best != least) result.push_back(best->at);
  return result;
}

/// Those with the least losses, from the least on; none without a finite one.
void keep_least(std::vector<named_parameters>& starts, const objective& loss, std::size_t most) {
  if (starts.size() <= most) return;
  std::vector<start_with_loss> all;
  for (auto& start : starts) {
    const double value = loss(start.theta).value;
    if (std::isfinite(value)) all.push_back({std::move(start), value});
  }
  std::ranges::stable_sort(all, {}, &start_with_loss::loss);
  starts.clear();
  for (std::size_t n = 0; n < std::min(most, all.size()); ++n) starts.push_back(std::move(all[n].at));
}

/// Puts in place of the starts what the stages lead to, and adds minima of the one-step loss. The number of
/// steps of the stage at which the search is given up; 0: it is not.
int pass_stages(const search_task& task, std::vector<named_parameters>& starts) {
  // Minima that are carried on: three from the last stage, four times as many from each before.
  std::vector<std::size_t> most_of(task.stages.size(), 3);
  for (std::size_t n = task.stages.size(); n-- > 1;) most_of[n - 1] = 4 * most_of[n];
  std::vector<named_parameters> of_one_step;
  for (std::size_t n = 0; n < task.stages.size(); ++n) {
    const search_stage& stage = task.stages[n];
    if (starts.size() <= most_of[n]) continue;
    auto [next, least] = most_promising(task, stage.loss, starts, most_of[n]);
    if (least > stage.lost_above && task.kept.empty()) return stage.steps;
    if (!next.empty()) starts = std::move(next);
    if (task.one_step_loss && of_one_step.empty()) of_one_step = one_step_minima(task, starts);
  }
  starts.insert(starts.end(), of_one_step.begin(), of_one_step.end());
  return 0;
}

/// Where minima are admitted, or the search at the edge of those that are.
bool is_allowed(const search_task& task, const Eigen::VectorXd& theta) {
  const auto& admits = task.admits_at_edge ? task.admits_at_edge : task.admits;
  return task.family->is_defined(theta) && task.family->is_in_range(theta) && admits(theta);
}

/// Where all minima that are admitted err by more than twice what a refused one does, or by more than a kept
/// start, there may be better ones at the edge.
bool edge_may_be_better(const search_task& task, const candidate& found, const candidate& least) {
  constexpr double twofold = 4.0;  // of squared errors
  if (found.theta == least.theta) return false;
  return twofold * least.judged < found.judged ||
         std::ranges::any_of(task.kept, [&](const named_parameters& start) {
           return task.judge(start.theta) < found.judged && is_allowed(task, start.theta);
         });
}

/// What searches among admitted points only lead to. A search along the edge of stability takes many passes
/// over the data: twelve starts go on for some passes, and the best three of them to the end.
std::vector<candidate> along_edge(const search_task& task, std::vector<named_parameters> from) {
  constexpr std::size_t most = 12;
  constexpr std::size_t most_to_the_end = 3;
  constexpr int some_passes = 40;
  const auto admits = [&](const Eigen::VectorXd& theta) { return is_allowed(task, theta); };
  std::erase_if(from, [&](const named_parameters& start) { return !admits(start.theta); });
  keep_least(from, task.loss, most);
  if (from.size() > most_to_the_end) {
    for (auto& start : from) {
      start.theta = descend_at_edge(task.loss, admits, start.theta, task.free, some_passes);
    }
    keep_least(from, task.loss, most_to_the_end);
  }
  if (task.most_stable_member && admits(task.most_stable_member->theta)) {
    from.push_back(*task.most_stable_member);
  }
  std::vector<candidate> held;
  for (const auto& start : from) {
    candidate one{
        .from = start.name, .theta = start.theta, .hessian = {}, .free = task.free, .is_held = true};
    one.theta = descend_at_edge(task.loss, admits, start.theta, task.free);
    one.loss = task.loss(one.theta).value;
    one.judged = task.judge(one.theta);
    held.push_back(one);
  }
  return held;
}

}  // namespace

search_result search(const search_task& task, const std::vector<named_parameters>& given) {
  std::vector<named_parameters> starts = given;
  search_result result{.best = {}, .unguarded = {}, .tried = static_cast<int>(given.size())};
  result.lost_after = pass_stages(task, starts);
  if (result.lost_after > 0) return result;
  starts.insert(starts.end(), task.kept.begin(), task.kept.end());
  const auto is_defined = [&](const Eigen::VectorXd& theta) { return task.family->is_defined(theta); };
  std::vector<candidate> all;
  for (const auto& start : starts) all.push_back(descend(task, is_defined, start));
  result.best = all.front();
  const bool are_chosen = starts.size() < given.size();
  if (are_chosen) {  // what is left is near its minimum: it may take many steps to come there
    for (auto& one : all) one.in_valley = !one.converged;
  }
  std::erase_if(all, [](const candidate& c) { return !c.converged && !c.in_valley; });
  const auto sound = by_judgement(std::move(all), task.free);
  if (sound.empty()) return result;
  const auto found = first_to_withstand(task, sound);
  result.best = found.value_or(sound.front());
  if (result.best.theta != sound.front().theta || !found) result.unguarded = sound.front();
  if (found && !edge_may_be_better(task, *found, sound.front())) return result;

  std::vector<named_parameters> from = starts;
  if (are_chosen) from.insert(from.end(), given.begin(), given.end());
  auto held = along_edge(task, std::move(from));
  result.tried += static_cast<int>(held.size());
  held = by_judgement(std::move(held), task.free);
  const auto at_edge = first_to_withstand(task, held);
  constexpr double hardly = 0.99;  // a minimum, of which more is known, is as good
  if (found ? at_edge && at_edge->judged < hardly * found->judged : !held.empty()) {
    result.best = at_edge ? *at_edge : held.front();
  }
  return result;
}

}  // namespace nysalt
