// SPDX-License-Identifier: BSL-1.0
// How often the error bars of few trajectories cover what many say, and whether those that do not are marked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nysalt/analysis/statistics.hpp"

namespace nysalt::coverage {

/// How much is tried of each bundled system.
struct extent {
  std::vector<std::string> systems;  // names; empty: all
  std::vector<std::string> methods{"verlet", "mclachlan5", "srkn6b", "chin4a"};
  std::vector<double> angles{0.1, 0.25};  // of the fastest motion, an evaluation
  double turns = 30.0;                    // horizon, times that frequency
  int samples = 16;
  std::int64_t of_sample = 400;                           // trajectories
  std::int64_t many = 40'000;                             // what counts as the truth
  std::vector<std::int64_t> between{100, 1'000, 10'000};  // errors at other numbers of trajectories
  int threads = 1;
};

/// One method at one step by one metric.
struct row {
  std::string system;
  std::string metric;
  std::string method;
  double step;
  estimate truth;       // of many
  bool truth_has_tail;  // few of the many decide
  int samples;
  int covered = 0;                // samples whose 95 % interval holds the truth, within the truth's own
  int marked = 0;                 // samples that are marked `tail`
  int misled = 0;                 // samples that neither cover nor are marked
  std::vector<estimate> between;  // errors at other numbers of trajectories
  bool agrees = true;             // those agree with the truth within three standard errors, or are marked

  /// Marked, as most of its samples are, or as the many are.
  bool has_tail() const { return truth_has_tail || 2 * marked > samples; }
  /// As often as 13 of 16: fewer come by chance in less than one of a hundred rows.
  bool covers() const { return 16 * covered >= 13 * samples; }
};

/// By every metric that a system has: the state, its default observable, a coordinate, its energy, and how
/// stiff springs exchange theirs. Trajectories that diverged leave a row out.
std::vector<row> covered_rows(const extent& what);

/// As a page in Markdown, and as comma-separated values.
std::string page_of(const std::vector<row>& all, const extent& what);
std::string csv_of(const std::vector<row>& all);

}  // namespace nysalt::coverage
