// SPDX-License-Identifier: BSL-1.0
// Candidates at one cost that are left behind on few trajectories, and those that are learned from all.
// Source: [jamieson_talwalkar_2016, section 2], successive halving.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "learning.hpp"
#include "recommendation.hpp"

namespace nysalt::program {

namespace {

ratio_estimate ratio_of(const candidate& one, const candidate& other, const error_statistic& by) {
  return paired_ratio(one.error.scores, other.error.scores, by);
}

/// The least error on trajectories that both ran; null of none.
const candidate* least_of(const std::vector<const candidate*>& all, const error_statistic& by) {
  const candidate* best = nullptr;
  for (const candidate* one : all) {
    if (best == nullptr || ratio_of(*one, *best, by).value < 1.0) best = one;
  }
  return best;
}

}  // namespace

/// Each time three times as many, up to all. To judge costs less than to learn, and tails of errors show on
/// many trajectories only: so all are judged on more than they are learned from. Scouts start from few
/// points; who is left is searched for from everywhere on a third of the trajectories, which show the same
/// minima, or on all where these are few.
std::vector<recommendation::stage> recommendation::stages() const {
  constexpr std::int64_t fewest = 16;  // a pass over fewer costs as much: they are the lanes of a processor
  const auto part = [](std::int64_t all, std::int64_t divisor, std::int64_t at_least) {
    return divisor == 1 ? all : std::min(all, std::max(at_least, all / divisor / fewest * fewest));
  };
  std::vector<stage> result;
  bool is_searched_for = false;  // from everywhere
  for (const std::int64_t divisor : {9, 3, 1}) {
    stage next{part(options_.learning.trajectories, divisor, fewest),
               part(options_.trajectories, std::max<std::int64_t>(divisor / 3, 1), 2 * fewest),
               start_set::known};
    const bool is_scout = divisor == 9 && next.learned_from < options_.learning.trajectories;
    if (!is_searched_for) next.starts = is_scout ? start_set::few : start_set::all;
    is_searched_for = is_searched_for || !is_scout;
    const bool is_new = result.empty() || next.learned_from > result.back().learned_from ||
                        next.judged_on > result.back().judged_on;
    if (is_new) {
      result.push_back(next);
    } else if (next.starts == start_set::all) {
      result.back().starts = start_set::all;
    }
  }
  return result;
}

void recommendation::race(const contest& among, std::vector<candidate*> racing) {
  const auto all = stages();
  for (std::size_t n = 0; n < all.size(); ++n) {
    shown_.count(static_cast<std::size_t>(std::ranges::count_if(racing, &candidate::is_learned)), "families");
    for (candidate* contender : racing) {
      if (contender->is_learned()) shown_.next();
      advance(among, *contender, all[n]);
    }
    shown_.count(0, "");
    measure_on_test(racing, all[n].judged_on);
    if (n + 1 < all.size()) leave_behind(among, racing);
  }
}

/// What was learned from fewer trajectories, or in the other contest, is where the search goes on. What could
/// not be used is searched for from everywhere.
void recommendation::advance(const contest& among, candidate& contender, const stage& at) {
  if (!contender.is_learned()) {
    if (!contender.method && contender.reason.empty()) prepare(contender, 0);
    return;
  }
  const bool is_to_search = at.starts == start_set::all && !contender.is_searched_for;
  if (contender.learned_from >= at.learned_from && !is_to_search) return;
  const auto of_family = [](const contest& in, const std::string& name) {
    const auto found = std::ranges::find_if(
        in.all, [&](const candidate& one) { return one.source.family == name && one.learned; });
    return found == in.all.end() ? nullptr : &*found;
  };
  const std::string& name = *contender.source.family;
  const candidate* known = contender.learned ? &contender : nullptr;
  if (known == nullptr && by_evaluations_ && &among != &*by_evaluations_)
    known = of_family(*by_evaluations_, name);
  search_starts starts{.which = at.starts};
  const auto inner = family_named(name, system_->letters()).contained;
  if (inner && options_.learning.fix.empty()) {
    constexpr double alike = 1.1;  // steps as far apart have optima that are close
    const candidate* one = of_family(among, inner->family.name);
    if (one != nullptr && one->learned->fit.usable &&
        std::abs(std::log(one->step / contender.step)) < std::log(alike)) {
      starts.contained = theta_of(one->learned->fit);
    }
  }
  if (known != nullptr) {
    const fit_summary& fit = known->learned->fit;
    if (fit.usable) starts.known = theta_of(fit);
    const bool is_end = starts.which == start_set::known && !fit.follows_to_the_end();
    if (!fit.usable || is_end) starts.which = start_set::all;
  }
  prepare(contender, at.learned_from, starts);
}

/// Those whose errors are larger than the least by more than chance and more data can change, and where they
/// are many all but the best third of families, whose learning is the cost. The best of either kind stays. A
/// fit that cannot be used is tried once more.
void recommendation::leave_behind(const contest& among, std::vector<candidate*>& racing) const {
  std::erase_if(racing, [](const candidate* one) {
    const bool is_hopeless =
        one->reason.empty() ? !one->has_error() : !one->learned || one->learned->fit.usable;
    return is_hopeless;
  });
  // Not std::ranges::stable_partition: clang++ 14 does not compile what it returns.
  const auto measured = std::stable_partition(racing.begin(), racing.end(),
                                              [](const candidate* one) { return !one->has_error(); });
  std::vector<candidate*> in_order(measured, racing.end());
  racing.erase(measured, racing.end());
  if (in_order.empty()) return;
  std::ranges::stable_sort(in_order, {}, [&](const candidate* one) { return among.error_of(*one); });
  std::vector<const candidate*> known(in_order.begin(), in_order.end());
  for (const auto& one : among.all) {
    if (one.is_eligible()) known.push_back(&one);
  }
  const candidate* best = least_of(known, among.statistic);
  constexpr std::size_t fewest = 3;
  const std::size_t most = std::max(fewest, (in_order.size() + 2) / 3);
  for (std::size_t n = 0; n < in_order.size(); ++n) {
    candidate& one = *in_order[n];
    const ratio_estimate ratio = ratio_of(one, *best, among.statistic);
    // A fit to n trajectories that count alike adds at most the share p / n to the mean square of an error, p
    // the number of parameters: each trajectory counted as one residual.
    double more_data = 1.0;
    if (one.is_learned()) {
      const fit_summary& fit = one.learned->fit;
      const double alike = std::isfinite(fit.deciding_trajectories)
                               ? std::min(fit.deciding_trajectories, static_cast<double>(one.learned_from))
                               : 1.0;
      more_data = std::sqrt(1.0 + static_cast<double>(fit.parameters.size()) / std::max(alike, 1.0));
    }
    const bool is_beyond = one.is_learned() && n >= most;
    if (n == 0 || !(ratio.low > more_data || is_beyond)) {
      racing.push_back(&one);
      continue;
    }
    one.is_left_behind = true;
    one.reason = fmt::format("left behind on {} of {} trajectories: its error was {:.3g} times that of {}",
                             one.error.trajectories, options_.trajectories, ratio.value, best->source.typed);
  }
}

bool recommendation::is_ahead(const contest& among, const candidate& one, const candidate& other) const {
  return options_.error ? among.cost_of(one) < among.cost_of(other)
                        : ratio_of(one, other, among.statistic).value < 1.0;
}

void recommendation::go_on(const contest& among, candidate& contender) {
  contender.is_left_behind = false;
  contender.reason.clear();
  if (options_.error) {
    find_steps({&contender}, among.unit);
  } else {
    for (const stage& next : stages()) advance(among, contender, next);
  }
  measure_on_test({&contender}, options_.trajectories);
}

bool recommendation::call_back(contest& among) {
  for (const bool learned : {true, false}) {
    candidate* next = nullptr;
    for (auto& one : among.all) {
      if (!one.is_left_behind || one.is_learned() != learned) continue;
      if (next == nullptr || is_ahead(among, one, *next)) next = &one;
    }
    const candidate* best = among.best_of(learned);
    if (next == nullptr || (best != nullptr && !is_ahead(among, *next, *best))) continue;
    go_on(among, *next);
    return true;
  }
  return false;
}

}  // namespace nysalt::program
