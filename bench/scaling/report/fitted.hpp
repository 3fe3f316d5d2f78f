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
  double seconds(const series& its) const {
    const auto share = static_cast<double>(its.largest_share);
    const auto steps = static_cast<double>(its.steps);
    const double sum = its.ranks > 1 ? reduction.seconds(its.ranks, bytes_of_pass(2)) : 0.0;
    if (its.what == "two-stage") return two_stage.seconds(steps, share) + sum;
    if (its.what == "BAOAB") return baoab.seconds(steps, share) + sum;
    if (its.what == "data") return data.seconds(its.largest_pairs()) + sum;
    if (its.what == "pass") return pass.seconds(its.largest_pairs()) + sum;
    return learn.seconds(its.largest_pairs()) + passes() * sum;
  }
};

namespace detail {

inline bool is_alone(const series& its) { return its.ranks == 1 && its.threads == 1; }

inline stepping_costs fit_stepping(const measured& all, const std::string& what) {
  std::vector<observation> seen;
  for (const series& its : all.of(what)) {
    const auto share = static_cast<double>(its.largest_share);
    if (is_alone(its)) seen.push_back({{share * static_cast<double>(its.steps), share}, its.middle()});
  }
  const auto costs = fitted_costs(seen);
  return {costs.at(0), costs.at(1)};
}

inline pairs_costs fit_pairs(const measured& all, const std::string& what) {
  std::vector<observation> seen;
  for (const series& its : all.of(what)) {
    if (is_alone(its)) seen.push_back({{its.largest_pairs(), 1.0}, its.middle()});
  }
  const auto costs = fitted_costs(seen);
  return {costs.at(0), costs.at(1)};
}

/// Ranks beyond the cores wait for a core, not for messages: they do not count.
inline reduction_costs fit_reductions(const measured& all) {
  std::vector<observation> seen;
  for (const sums& its : all.reductions) {
    if (!its.has_cores()) continue;
    const double bytes = 8.0 * its.doubles;
    const double levels = levels_over(its.ranks);
    for (const double seconds : its.seconds) seen.push_back({{1.0, bytes, levels, levels * bytes}, seconds});
  }
  const auto costs = fitted_costs(seen);
  return {costs.at(0), costs.at(1), costs.at(2), costs.at(3)};
}

inline memory_costs fit_memory(const measured& all) {
  std::vector<observation> seen;
  for (const memory_of_rank& its : all.memory) {
    const auto share = static_cast<double>(its.share);
    seen.push_back({{1.0, share * static_cast<double>(its.steps), share}, its.bytes});
  }
  const auto costs = fitted_costs(seen);
  return {costs.at(0), costs.at(1), costs.at(2)};
}

/// Of BAOAB with as much a rank, on as many ranks as were measured.
inline double slower_when_full(const measured& all) {
  const series* most = nullptr;
  const auto times = all.of("BAOAB");
  for (const series& its : times) {
    if (its.scaling == "weak" && (most == nullptr || its.ranks > most->ranks)) most = &its;
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
