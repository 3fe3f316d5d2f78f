// SPDX-License-Identifier: BSL-1.0
// What is asked of the library: every row of the table.
#pragma once

#include <algorithm>
#include <string>

#include "../../src/report/table.hpp"
#include "row.hpp"

namespace nysalt::bench {

/// Peers and ours with the same flags, contraction off. What fusing changes stands in rows without a target.
inline std::vector<row> fixed_rows() {
  using enum measure;
  return {
      {"ensemble, two-stage: speed of its mix of operations", "ensemble", "ours", {"same mix"}, speed, 0.80},
      {"ensemble: time of a hand-written kernel", "ensemble", "ours", {"hand-written"}, time, 1.05},
      {"ensemble: speed-up over Boost.Odeint", "ensemble", "ours", {"odeint arrays"}, speed, 7.0},
      {"ensemble: speed-up over Boost.Odeint with packs", "ensemble", "ours", {"odeint packs"}, speed, 1.25},
      {"one trajectory, Verlet: time of Boost.Odeint",
       "single trajectory",
       "ours",
       {"odeint velocity_verlet", "odeint Nystrom stepper"},
       time,
       0.9},
      {"noise: speed-up over std::normal_distribution",
       "noise",
       "ours",
       {"std::normal_distribution", "std::normal_distribution, splitmix64"},
       speed,
       4.5},
      {"noise: speed-up over Boost's ziggurat",
       "noise",
       "ours",
       {"Boost's ziggurat", "Boost's ziggurat, splitmix64"},
       speed,
       1.8},
      {"BAOAB in lanes: speed-up over std::normal_distribution",
       "langevin",
       "ours",
       {"std::normal_distribution", "std::normal_distribution, splitmix64"},
       speed,
       5.5},
      {"BAOAB in lanes: speed-up over Boost's ziggurat",
       "langevin",
       "ours",
       {"Boost's ziggurat", "Boost's ziggurat, splitmix64"},
       speed,
       2.2},
      {"learner, 10^5 samples: speed-up over a block for each",
       "learning",
       "compressed",
       {"block per sample"},
       speed,
       10.0},
      {"learner, a pass over 10^5 pairs: time of its arithmetic",
       "learning pass",
       "pass",
       {"same number of operations"},
       time,
       1.3},
      {"chain of 1000 masses: time of the textbook's loop", "long chain", "ours", {"textbook"}, time, 0.6},
      {"two threads: speed-up over one",
       "threads",
       "two threads",
       {"one thread"},
       speed,
       1.8,
       "g++",
       premise{"kernel, two threads", "kernel, one thread", 1.9,
               "the machine is not quiet: two threads of a kernel that shares nothing gain too little"}},
      {"one chain of 10^6 masses: speed-up over the textbook's loop",
       "one chain of 10^6",
       "one thread",
       {"textbook"},
       speed,
       2.0},
      {"one chain of 10^6 masses, two threads: speed-up over one",
       "one chain of 10^6",
       "two threads",
       {"one thread"},
       speed,
       1.8},
      {"one chain of 10^7 masses: speed-up over the textbook's loop",
       "one chain of 10^7",
       "one thread",
       {"textbook"},
       speed,
       2.0},
      {"one chain of 10^7 masses, two threads: speed-up over one",
       "one chain of 10^7",
       "two threads",
       {"one thread"},
       speed,
       1.8},
      {"by the library, ensemble: time of the typed system",
       "ensemble",
       "ours, by the library",
       {"ours"},
       time,
       1.15},
      {"by the library, BAOAB in lanes: time of the typed system",
       "langevin",
       "ours, by the library",
       {"ours"},
       time,
       1.1},
      {"by the library, one trajectory: time of the typed system",
       "single trajectory",
       "ours, by the library",
       {"ours"},
       time,
       1.3},
  };
}

inline std::vector<row> reported_rows() {
  using enum measure;
  std::vector<row> result{
      {"moving the data of 10^6 masses, two threads: speed-up over one",
       "one chain of 10^6",
       "moving the data, two threads",
       {"moving the data, one thread"}},
      {"moving the data of 10^7 masses, two threads: speed-up over one",
       "one chain of 10^7",
       "moving the data, two threads",
       {"moving the data, one thread"}},
      {"ensemble: share of the peak of fused multiply-adds", "ensemble", "ours", {"fused multiply-adds"}},
      {"ensemble, ours fused: the same share", "ensemble", "ours, fused", {"fused multiply-adds"}},
      {"ensemble: time of a hand-written kernel, constants folded",
       "ensemble",
       "ours",
       {"hand-written, folded"},
       time},
      {"ensemble, both fused: time of a hand-written kernel",
       "ensemble",
       "ours, fused",
       {"hand-written, fused", "hand-written, folded, fused"},
       time},
      {"ensemble, both fused: speed-up over Boost.Odeint",
       "ensemble",
       "ours, fused",
       {"odeint arrays, fused"}},
      {"ensemble, both fused: speed-up over Boost.Odeint with packs",
       "ensemble",
       "ours, fused",
       {"odeint packs, fused"}},
      {"ensemble, only they fused: speed-up over Boost.Odeint", "ensemble", "ours", {"odeint arrays, fused"}},
      {"ensemble, only they fused: speed-up over Boost.Odeint with packs",
       "ensemble",
       "ours",
       {"odeint packs, fused"}},
      {"ensemble: speed-up over Boost.Odeint, steps merged by hand",
       "ensemble",
       "ours",
       {"odeint arrays, merged"}},
      {"ensemble: speed-up over Boost.Odeint with packs, steps merged by hand",
       "ensemble",
       "ours",
       {"odeint packs, merged"}},
      {"one trajectory, only they fused: time of Boost.Odeint",
       "single trajectory",
       "ours",
       {"odeint velocity_verlet, fused", "odeint Nystrom stepper, fused"},
       time},
      {"chain of 1000 masses, only they fused: time of the textbook's loop",
       "long chain",
       "ours",
       {"textbook, fused"},
       time},
      {"learner, a pass over 10^5 pairs: time of reading the data alone",
       "learning pass",
       "pass",
       {"reading the data alone"},
       time},
      {"liquid of 4000 atoms: time of LAMMPS", "liquid", "ours, 4000 atoms", {"LAMMPS, 4000 atoms"}, time},
      {"liquid of 32000 atoms: time of LAMMPS", "liquid", "ours, 32000 atoms", {"LAMMPS, 32000 atoms"}, time},
      {"liquid of 32000 atoms, two threads: speed-up over one",
       "liquid on threads",
       "two threads",
       {"one thread"}},
      {"beside it a kernel that shares nothing, two threads: speed-up over one",
       "liquid on threads",
       "kernel, two threads",
       {"kernel, one thread"}},
      {"BAOAB in lanes: share of its noise alone", "langevin", "noise alone", {"ours"}, time},
      {"two-stage in a bath, O symmetric: time of the step with none",
       "langevin",
       "two-stage, O symmetric",
       {"two-stage, no bath"},
       time},
      {"two-stage in a bath, O symmetric: time of O at the end",
       "langevin",
       "two-stage, O symmetric",
       {"two-stage, O at the end"},
       time},
      {"compiling a first example, time with the learner against without",
       "compiling",
       "with learner",
       {"without learner"},
       time},
  };
  for (const std::string race : {"words, one trajectory", "words, lanes"}) {
    for (const std::string letters : {"A B", "A B, eleven stages", "G", "R S", "O"}) {
      result.push_back({fmt::format("{}, {}, by the library: time of the typed system", race, letters),
                        race,
                        letters + ", by the library",
                        {letters},
                        time});
    }
  }
  return result;
}

/// Sizes of an ensemble or a chain, and what streaming as many bytes takes, if that was measured.
struct growth {
  std::string name;
  std::string race;
  std::vector<std::string> sizes;  // from small to large
  std::string stream{};            // followed by the size; empty: never memory bound
  double bytes = 0.0;              // of a unit of the size
};

/// The largest cost of a unit of work relative to that of the smallest size, up to where memory bounds it:
/// the first size at which moving the data alone takes as long as the whole step of the smallest size.
inline row growth_row(const growth& g, const measurements& all) {
  row result{g.name, g.race, g.sizes.front(), {g.sizes.front()}, measure::time, 1.3};
  result.note = fmt::format("no memory bound up to {}", g.sizes.back());
  const double smallest = median(all.of(g.race, g.sizes.front()));
  double largest = 0.0;
  for (std::size_t i = 1; i < g.sizes.size(); ++i) {
    if (!g.stream.empty() && median(all.of(g.race, g.stream + g.sizes[i])) >= smallest) {
      result.note = fmt::format("memory bound from {} on, where the state takes {:.0f} kB", g.sizes[i],
                                std::stod(g.sizes[i]) * g.bytes / 1024.0);
      break;
    }
    const double here = median(all.of(g.race, g.sizes[i]));
    if (here > largest) result.subject = g.sizes[i];
    largest = std::max(largest, here);
  }
  return result;
}

/// A line a size.
inline nysalt::table to_table(const growth& g, const measurements& gnu, const measurements& clang) {
  const bool streamed = !g.stream.empty();
  nysalt::table result({"size", "g++", "clang++", "moving the data alone"}, 0);
  const auto number = [&](const measurements& all, const std::string& runner) {
    return all.has(g.race, runner) ? fmt::format("{:.3g}", median(all.of(g.race, runner))) : std::string("-");
  };
  for (const auto& size : g.sizes) {
    result.add({size, number(gnu, size), number(clang, size), streamed ? number(gnu, g.stream + size) : "-"});
  }
  return result;
}

inline std::vector<growth> growths() {
  return {{"cost of a trajectory-step, 10^3 to 10^6 trajectories",
           "growing ensemble",
           {"1000", "10000", "100000", "1000000"}},
          {"cost of a mass-step, 10^3 masses to where memory bounds it",
           "growing chain",
           {"1000", "3000", "10000", "30000", "100000", "300000", "1000000"},
           "stream ",
           16.0}};
}

}  // namespace nysalt::bench
