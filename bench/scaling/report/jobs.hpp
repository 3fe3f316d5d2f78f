// SPDX-License-Identifier: BSL-1.0
// 10^9 trajectories on 10^4 cores, on paper.
#pragma once

#include <cstdint>
#include <string>

#include "../../../src/report/table.hpp"
#include "foretold.hpp"
#include "units.hpp"

namespace nysalt::bench {

inline constexpr std::int64_t trajectories_of_jobs = 1'000'000'000;
inline constexpr std::int64_t steps_of_learning = 16;
inline constexpr double steps_of_run = 1e6;
inline constexpr double looks_of_run = 1000.0;  // times at which sums are wanted

inline std::string percent(double part) { return fmt::format("{:.3g} %", 100.0 * part); }

inline table assumptions(const cluster& where) {
  table result({"assumed", "value"});
  result.add({"ranks, one a core", fmt::format("{}", where.ranks)});
  result.add({"a message between machines takes", duration(where.latency)});
  result.add({"and for its bytes, one link of", amount(where.bandwidth) + "/s"});
  result.add({"the slowest rank is slower than the median by", percent(where.spread)});
  result.add({"until all ranks run", duration(where.start_up)});
  result.add({"one rank writes to the shared disk", amount(where.disk) + "/s"});
  return result;
}

inline table learning_job(const foretold& on, const cluster& where) {
  constexpr std::int64_t m = trajectories_of_jobs;
  constexpr std::int64_t n = steps_of_learning;
  const std::int64_t r = where.ranks;
  table result({"learning from 10^9 trajectories of 16 steps", "one core", fmt::format("{} cores", r)});
  const auto add = [&](const char* what, auto seconds) {
    result.add({what, duration(seconds(1)), duration(seconds(r))});
  };
  const auto share = [&](std::int64_t ranks) { return fmt::format("{:.4g}", foretold::share(m, ranks)); };
  const auto total = [&](std::int64_t ranks) {
    return on.making_data(m, n, ranks) + on.learning(m, n, ranks);
  };
  result.add({"trajectories of the largest share", share(1), share(r)});
  result.add({"memory of a rank", amount(on.memory(m, n, 1)), amount(on.memory(m, n, r))});
  add("making data and held-out data", [&](auto ranks) { return on.making_data(m, n, ranks); });
  add("a pass over the data", [&](auto ranks) { return on.pass(m, n, ranks); });
  add("of it the sum over the ranks", [&](auto ranks) { return on.sum(ranks); });
  add("learn()", [&](auto ranks) { return on.learning(m, n, ranks); });
  add("of it what each rank does again", [&](auto) { return on.serial(); });
  add("all, without start-up", total);
  result.add({"efficiency, without start-up", "1", fmt::format("{:.3g}", efficiency(total, r))});
  const auto started = [&](std::int64_t ranks) { return total(ranks) + (ranks > 1 ? where.start_up : 0.0); };
  result.add({"efficiency, with it", "1", fmt::format("{:.3g}", efficiency(started, r))});
  return result;
}

inline table langevin_job(const foretold& on, const cluster& where) {
  constexpr std::int64_t m = trajectories_of_jobs;
  const std::int64_t r = where.ranks;
  table result({"10^6 steps of BAOAB each, sums at 1000 times", "one core", fmt::format("{} cores", r)});
  const auto run = [&](std::int64_t ranks) { return on.run(m, steps_of_run, looks_of_run, ranks); };
  result.add({"all steps and sums, without start-up", duration(run(1)), duration(run(r))});
  result.add({"of it sums over the ranks", duration(0.0), duration(looks_of_run * on.sum(r))});
  result.add({"efficiency, without start-up", "1", fmt::format("{:.3g}", efficiency(run, r))});
  return result;
}

/// A row a trajectory, of a number, a time and two observables: what it takes to bring them together.
inline table gathering_job(const measured& all, const cluster& where) {
  table result(
      {"10^9 rows at rank 0", "times", "bytes of one", "bytes", "on the way", "made", "to the disk"});
  constexpr double numbers = 32.0;  // bytes of four
  for (const auto& [what, written_row] : all.rows) {
    for (const double times : {1.0, looks_of_run}) {
      const double rows = times * static_cast<double>(trajectories_of_jobs);
      result.add({what, fmt::format("{}", times), fmt::format("{:.3g}", written_row.bytes),
                  amount(written_row.bytes * rows), duration(numbers * rows / where.bandwidth),
                  duration(median(written_row.seconds) * rows),
                  duration(written_row.bytes * rows / where.disk)});
    }
  }
  return result;
}

inline table too_many(const foretold& on) {
  table result({"trajectories of 16 steps", "a share is a leaf from ... ranks on",
                "the sum is a tenth of a pass from ... ranks on"},
               0);
  for (const std::int64_t m : {1'000, 100'000, 10'000'000, 1'000'000'000}) {
    result.add({fmt::format("{:.0e}", static_cast<double>(m)),
                fmt::format("{}", (m + detail::trajectories_of_leaf - 1) / detail::trajectories_of_leaf),
                fmt::format("{:.2g}", static_cast<double>(on.ranks_of_dear_sums(m, steps_of_learning)))});
  }
  return result;
}

}  // namespace nysalt::bench
