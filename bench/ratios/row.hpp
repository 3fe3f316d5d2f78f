// SPDX-License-Identifier: BSL-1.0
// A row of the table: who is compared with whom, and what is asked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verdict.hpp"

namespace nysalt::bench {

/// `speed` is how many times as fast as the others: their time over ours. `time` is ours over theirs.
enum class measure { speed, time };

/// Says whether the machine can show what a row asks: the same ratio of a kernel that certainly can.
struct premise {
  std::string subject;
  std::string against;
  double at_least;
  std::string otherwise;  // the reason why nothing can be said
};

struct row {
  std::string name;
  std::string race;
  std::string subject;
  std::vector<std::string> against;  // the fastest of these
  nysalt::bench::measure measure = nysalt::bench::measure::speed;
  std::optional<double> bound{};  // speed at least, time at most; none: only reported
  std::string compiler = "g++";
  std::optional<nysalt::bench::premise> premise{};
  std::string note{};
};

struct judged_row {
  nysalt::bench::row row;
  std::string against;
  ratio found;
  verdict said;
  double subject_ns;
  double against_ns;
  std::optional<ratio> beside;  // the other compiler's
};

inline bool is_there(const measurements& all, const row& r) {
  bool result = all.has(r.race, r.subject);
  for (const auto& other : r.against) result = result && all.has(r.race, other);
  return result;
}

/// The one of smallest median.
inline std::string fastest(const measurements& all, const row& r) {
  std::string best = r.against.at(0);
  for (const auto& other : r.against) {
    if (median(all.of(r.race, other)) < median(all.of(r.race, best))) best = other;
  }
  return best;
}

inline ratio ratio_of(const measurements& all, const row& r) {
  const auto& ours = all.of(r.race, r.subject);
  const auto& theirs = all.of(r.race, fastest(all, r));
  return r.measure == measure::speed ? paired_ratio(theirs, ours) : paired_ratio(ours, theirs);
}

/// `mine` are of the row's compiler, `others` of the other one. Throws std::runtime_error if somebody did not
/// run.
inline judged_row judge(const row& r, const measurements& mine, const measurements* others = nullptr) {
  judged_row result{r, fastest(mine, r), ratio_of(mine, r), {}, 0.0, 0.0, {}};
  result.subject_ns = median(mine.of(r.race, r.subject));
  result.against_ns = median(mine.of(r.race, result.against));
  if (others != nullptr && is_there(*others, r)) result.beside = ratio_of(*others, r);
  if (!r.bound) return result;
  result.said = judge(result.found, target{r.measure == measure::speed, *r.bound});
  if (r.premise && result.said.holds != true) {
    const auto& p = *r.premise;
    const ratio can = paired_ratio(mine.of(r.race, p.against), mine.of(r.race, p.subject));
    if (can.value < p.at_least) {
      result.said = {std::nullopt,
                     fmt::format("{} ({:.3g} of at least {:g})", p.otherwise, can.value, p.at_least)};
    }
  }
  return result;
}

}  // namespace nysalt::bench
