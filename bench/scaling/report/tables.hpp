// SPDX-License-Identifier: BSL-1.0
// What was measured and fitted, as tables.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "../../../src/report/table.hpp"
#include "fitted.hpp"
#include "units.hpp"

namespace nysalt::bench {

inline std::string name_of(const std::string& what) {
  if (what == "kernel") return "kernel that shares nothing";
  if (what == "two-stage") return "steps, two-stage";
  if (what == "BAOAB") return "steps in a bath, BAOAB";
  if (what == "data") return "making data";
  if (what == "pass") return "pass over the data";
  return "learn()";
}
inline const std::vector<std::string> kinds_of_work{"kernel", "two-stage", "BAOAB", "data", "pass", "learn"};

inline std::string interval(const ratio& r) { return fmt::format("{:.3g} - {:.3g}", r.low, r.high); }

/// Two ranks against one, and against two threads: what is asked, and whether it holds. A machine whose bare
/// kernel gains less than 1.9 has not two cores to give.
inline table acceptance(const measured& all) {
  table result({"what", "two ranks, speed-up", "95 %", ">= 1.8", "speed by two threads'", "95 %", ">= 0.95"});
  const auto speed_up = [&](const std::string& what) {
    return paired_ratio(all.find(what, "strong", 1, 1).seconds, all.find(what, "strong", 2, 1).seconds);
  };
  const ratio of_kernel = speed_up("kernel");
  const auto say = [&](const ratio& found, double bound) -> std::string {
    const auto holds = judge(found, target{true, bound}).holds;
    if (holds == true) return "yes";
    if (!holds || of_kernel.value < 1.9) return "?";
    return "NO";
  };
  for (const auto& what : kinds_of_work) {
    const ratio gain = speed_up(what);
    std::vector<std::string> cells{name_of(what), fmt::format("{:.3g}", gain.value), interval(gain),
                                   what == "kernel" ? "" : say(gain, 1.8)};
    if (what == "kernel") {
      cells.insert(cells.end(), {"", "", ""});
    } else {
      const ratio beside =
          paired_ratio(all.find(what, "strong", 1, 2).seconds, all.find(what, "strong", 2, 1).seconds);
      cells.insert(cells.end(), {fmt::format("{:.3g}", beside.value), interval(beside), say(beside, 0.95)});
    }
    result.add(cells);
  }
  return result;
}

/// T(1)/(R T(R)) of the same work, T(1)/T(R) of as much a rank.
inline ratio efficiency_of(const measured& all, const series& work) {
  ratio r = paired_ratio(all.find(work.what, "strong", 1, 1).seconds, work.seconds);
  const double by = work.scaling == "strong" ? work.ranks : 1.0;
  for (double* x : {&r.value, &r.low, &r.high}) *x /= by;
  return r;
}

inline table efficiencies(const measured& all, const fitted& model) {
  table result(
      {"what", "scaling", "ranks", "time", "efficiency", "95 %", "model's time", "measured by model"}, 2);
  for (const auto& what : kinds_of_work) {
    for (const series& work : all.of(what)) {
      if (work.scaling == "size" || work.threads > 1) continue;
      const ratio e = efficiency_of(all, work);
      std::vector<std::string> cells{name_of(what),
                                     work.scaling,
                                     fmt::format("{}", work.ranks),
                                     duration(work.middle()),
                                     fmt::format("{:.3g}", e.value),
                                     interval(e),
                                     "",
                                     ""};
      if (what != "kernel") {
        cells[6] = duration(model.seconds(work));
        cells[7] = fmt::format("{:.3g}", work.middle() / model.seconds(work));
      }
      result.add(cells);
    }
  }
  return result;
}

inline table sizes(const measured& all, const fitted& model) {
  table result({"what", "trajectories", "steps", "time", "model's time", "measured by model"});
  for (const series& work : all.times) {
    if (work.scaling != "size") continue;
    result.add({name_of(work.what), fmt::format("{}", work.trajectories), fmt::format("{}", work.steps),
                duration(work.middle()), duration(model.seconds(work)),
                fmt::format("{:.3g}", work.middle() / model.seconds(work))});
  }
  return result;
}

inline table costs(const fitted& m) {
  table result({"of", "cost", "value", "unit"}, 2);
  const auto add = [&](const char* of, const char* name, const cost& fitted_cost, const char* unit,
                       double size) {
    result.add({of, name, with_error(fitted_cost, size), unit});
  };
  add("two-stage", "t_step", m.two_stage.step, "ns a trajectory-step", 1e-9);
  add("two-stage", "t_start", m.two_stage.start, "ns a trajectory", 1e-9);
  add("BAOAB", "t_step", m.baoab.step, "ns a trajectory-step", 1e-9);
  add("BAOAB", "t_start", m.baoab.start, "ns a trajectory", 1e-9);
  add("data", "t_data", m.data.pair, "ns a pair", 1e-9);
  add("data", "t_0", m.data.none, "us", 1e-6);
  add("pass", "t_pair", m.pass.pair, "ns a pair", 1e-9);
  add("pass", "t_0", m.pass.none, "us", 1e-6);
  add("learn()", "t_learn", m.learn.pair, "ns a pair", 1e-9);
  add("learn()", "t_serial", m.learn.none, "ms", 1e-3);
  result.add({"learn()", "N = t_learn/t_pair", fmt::format("{:.3g}", m.passes()), "passes"});
  add("one sum", "a", m.reduction.here, "us", 1e-6);
  add("one sum", "a'", m.reduction.here_byte, "ns a byte", 1e-9);
  add("one sum", "b", m.reduction.level, "us a level", 1e-6);
  add("one sum", "beta", m.reduction.level_byte, "ns a byte and level", 1e-9);
  add("memory", "c_0", m.memory.none, "MB", 1e6);
  add("memory", "c_pair", m.memory.pair, "B a pair", 1.0);
  add("memory", "c_trajectory", m.memory.trajectory, "B a trajectory", 1.0);
  result.add({"a rank", "slower", fmt::format("{:.3g}", m.slower), "all cores busy, against one"});
  return result;
}

inline table reductions(const measured& all, const fitted& model) {
  table result({"ranks", "doubles", "median", "90 %", "model", "cores"}, 0);
  for (const sums& reduction : all.reductions) {
    result.add({fmt::format("{}", reduction.ranks), fmt::format("{}", reduction.doubles),
                duration(median(reduction.seconds)), duration(median(reduction.seconds_90)),
                reduction.has_cores()
                    ? duration(model.reduction.seconds(reduction.ranks, 8.0 * reduction.doubles))
                    : "-",
                reduction.has_cores() ? "one a rank" : "fewer than ranks"});
  }
  return result;
}

/// The largest and the smallest of the ranks.
inline table memory(const measured& all, const fitted& model) {
  table result({"trajectories", "pairs of each", "ranks", "most", "model", "least"}, 0);
  for (std::size_t i = 0; i < all.memory.size();) {
    const auto& first = all.memory[i];
    double least = first.bytes;
    double most = first.bytes;
    std::int64_t share = first.share;
    for (int r = 0; r < first.ranks; ++r, ++i) {
      least = std::min(least, all.memory[i].bytes);
      most = std::max(most, all.memory[i].bytes);
      share = std::max(share, all.memory[i].share);
    }
    const auto trajectories = static_cast<double>(share);
    const double pairs = trajectories * static_cast<double>(first.steps);
    result.add({fmt::format("{}", first.trajectories), fmt::format("{}", first.steps),
                fmt::format("{}", first.ranks), amount(most), amount(model.memory.bytes(pairs, trajectories)),
                amount(least)});
  }
  return result;
}

/// For programs: medians and quartiles.
inline table rows_of(const measured& all) {
  table result({"what", "scaling", "ranks", "threads", "trajectories", "steps", "largest_share", "rounds",
                "median_seconds", "lower_quartile", "upper_quartile"});
  for (const series& work : all.times) {
    samples sorted = work.seconds;
    std::sort(sorted.begin(), sorted.end());
    result.add({work.what, work.scaling, fmt::format("{}", work.ranks), fmt::format("{}", work.threads),
                fmt::format("{}", work.trajectories), fmt::format("{}", work.steps),
                fmt::format("{}", work.largest_share), fmt::format("{}", sorted.size()),
                fmt::format("{:.6g}", work.middle()), fmt::format("{:.6g}", sorted[sorted.size() / 4]),
                fmt::format("{:.6g}", sorted[3 * sorted.size() / 4])});
  }
  return result;
}

}  // namespace nysalt::bench
