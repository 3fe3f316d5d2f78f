// SPDX-License-Identifier: BSL-1.0
// The parts of the page, each with its data.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "../../../src/report/page.hpp"
#include "contest.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::sampling_benchmark {

struct extent {
  bool quick = false;  // smaller targets, and numbers to be looked at for their order alone
  int threads = 2;
  std::function<void()> save{};  // the page as it is, so that what is done is there if the rest is cut off
};

/// A word in a race over one target.
struct contender {
  method word;
  double step = 0.0;      // at an acceptance of 0.9
  double foretold = 0.0;  // on the small target; 0: it was not asked for
  outcome run{};
  std::string published{};  // evaluations to a low error, of others
};

/// Mean durations of trajectories that a race tries, and draws of each chain with them.
struct tried_length {
  double length;
  std::int64_t draws;
};

struct race {
  std::string name;
  std::vector<contender> words;
  double length = 0.0;  // common to all, chosen
};

/// Steps of all words at each length, and four chains with them. Where the step at an acceptance of 0.9 is
/// longer than the length, a word takes that length as its step if this costs less. The length whose costs
/// have the least geometric mean is taken for all.
race run_race(const std::string& name, const target& of, std::vector<contender> words,
              const statistic& measured, std::vector<double> error_curve::*judged_by,
              const std::vector<tried_length>& lengths, const extent& how);

/// A table of the race for people, and its rows for machines.
void add_race(const race& of, page& to, table& rows, bool by_largest);

table all_rows();

void add_gaussians(const extent& how, page& to, table& rows);
void add_lattice(const extent& how, page& to, table& rows);
void add_posterior(const extent& how, page& to, table& rows);

/// One of the bundled systems, with some of its parameters.
model bundled(const std::string& name,
              const std::vector<std::pair<std::string, parameter_value>>& given = {});

/// A line of what is under way.
void say(const std::string& text);

}  // namespace nysalt::sampling_benchmark
