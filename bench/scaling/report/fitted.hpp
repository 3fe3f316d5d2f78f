// SPDX-License-Identifier: BSL-1.0
// The cost model of what was measured. Seconds are those of one rank alone, so that what more ranks take is
// foretold, not fitted; only messages need more than one.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "cost_model.hpp"
#include "measured.hpp"

namespace nysalt::bench {

struct fitted {
  stepping_costs two_stage;
  stepping_costs baoab;
  pairs_costs data;
  pairs_costs pass;
  pairs_costs learn;
  reduction_costs reduction;
  memory_costs memory;
  double slower = 1.0;  // a rank beside as many others as the machine has cores, against one alone

  /// Passes over the data that learn() takes, whatever they are.
  double passes() const { return learn.pair.value / pass.pair.value; }

  /// What the model says of a piece of work, as if all cores were as quick as one alone.
  double seconds(const series& work) const {
    const auto share = static_cast<double>(work.largest_share);
    const auto steps = static_cast<double>(work.steps);
    const double sum = work.ranks > 1 ? reduction.seconds(work.ranks, bytes_of_pass(2)) : 0.0;
    if (work.what == "two-stage") return two_stage.seconds(steps, share) + sum;
    if (work.what == "BAOAB") return baoab.seconds(steps, share) + sum;
    if (work.what == "data") return data.seconds(work.largest_pairs()) + sum;
    if (work.what == "pass") return pass.seconds(work.largest_pairs()) + sum;
    return learn.seconds(work.largest_pairs()) + passes() * sum;
  }
};

namespace detail {

inline bool is_alone(const series& work) { return work.ranks == 1 && work.threads == 1; }

inline stepping_costs fit_stepping(const measured& all, const std::string& what) {
  std::vector<observation> seen;
  for (const series& work : all.of(what)) {
    const auto share = static_cast<double>(work.largest_share);
    if (is_alone(work)) seen.push_back({{share * static_cast<double>(work.steps), share}, work.middle()});
  }
  const auto costs = fitted_costs(seen);
  return {costs.at(0), costs.at(1)};
}

inline pairs_costs fit_pairs(const measured& all, const std::string& what) {
  std::vector<observation> seen;
  for (const series& work : all.of(what)) {
    if (is_alone(work)) seen.push_back({{work.largest_pairs(), 1.0}, work.middle()});
  }
  const auto costs = fitted_costs(seen);
  return {costs.at(0), costs.at(1)};
}

/// Ranks beyond the cores wait for a core, not for messages: they do not count.
inline reduction_costs fit_reductions(const measured& all) {
  std::vector<observation> seen;
  for (const sums& reduction : all.reductions) {
    if (!reduction.has_cores()) continue;
    const double bytes = 8.0 * reduction.doubles;
    const double levels = levels_over(reduction.ranks);
    for (const double seconds : reduction.seconds)
      seen.push_back({{1.0, bytes, levels, levels * bytes}, seconds});
  }
  const auto costs = fitted_costs(seen);
  return {costs.at(0), costs.at(1), costs.at(2), costs.at(3)};
}

inline memory_costs fit_memory(const measured& all) {
  std::vector<observation> seen;
  for (const memory_of_rank& usage : all.memory) {
    const auto share = static_cast<double>(usage.share);
    seen.push_back({{1.0, share * static_cast<double>(usage.steps), share}, usage.bytes});
  }
  const auto costs = fitted_costs(seen);
  return {costs.at(0), costs.at(1), costs.at(2)};
}

/// Of BAOAB with as much a rank, on as many ranks as were measured.
inline double slower_when_full(const measured& all) {
  const series* most = nullptr;
  const auto times = all.of("BAOAB");
  for (const series& work : times) {
    if (work.scaling == "weak" && (most == nullptr || work.ranks > most->ranks)) most = &work;
  }
  if (most == nullptr) return 1.0;
  return std::max(1.0, paired_ratio(most->seconds, all.find("BAOAB", "strong", 1, 1).seconds).value);
}

}  // namespace detail

inline fitted fit_model(const measured& all) {
  return {detail::fit_stepping(all, "two-stage"),
          detail::fit_stepping(all, "BAOAB"),
          detail::fit_pairs(all, "data"),
          detail::fit_pairs(all, "pass"),
          detail::fit_pairs(all, "learn"),
          detail::fit_reductions(all),
          detail::fit_memory(all),
          detail::slower_when_full(all)};
}

}  // namespace nysalt::bench
