// SPDX-License-Identifier: BSL-1.0
// A table, figure or remark of the paper [li_lu_tao_ye_2023], and what became of its claims here.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "report/plot.hpp"
#include "report/table.hpp"

namespace nysalt::program::paper {

/// One claim of the paper beside what was measured.
struct tested_claim {
  std::string claim;     // as it is printed
  std::string quantity;  // what we measured
  std::string ours;      // the figure with its error
  std::string verdict;   // see verdict_of
  std::string reason;    // by which rule
  std::string command;   // that gives the number; empty: none of the others does
};

/// A picture and what it shows.
struct shown_figure {
  figure picture;
  std::string caption;
};

struct exhibit {
  std::string title;
  std::string place;  // in the paper
  std::vector<tested_claim> claims;
  std::vector<std::string> remarks{};
  std::vector<std::pair<std::string, table>> tables{};  // each below a sentence
  std::vector<shown_figure> pictures{};
  double seconds = 0.0;  // that it took
};

/// A way to read the text, and whether the claim holds in it.
struct reading {
  std::string name;
  bool holds;
};

inline std::string verdict_of(bool holds) { return holds ? "reproduced" : "not reproduced"; }

/// The one verdict of all readings, or "depends on" what they differ in.
inline std::string verdict_of(const std::string& choice, const std::vector<reading>& readings) {
  std::size_t holding = 0;
  for (const auto& one : readings) holding += one.holds ? 1 : 0;
  if (holding == readings.size()) return verdict_of(true);
  return holding == 0 ? verdict_of(false) : "depends on " + choice;
}

/// "holds for a; fails for b, c"
inline std::string summary_of(const std::vector<reading>& readings) {
  std::string holds;
  std::string fails;
  for (const auto& one : readings) {
    std::string& list = one.holds ? holds : fails;
    list += list.empty() ? "" : ", ";
    list += one.name;
  }
  if (fails.empty()) return "holds for " + holds;
  return holds.empty() ? "fails for " + fails : fmt::format("holds for {}; fails for {}", holds, fails);
}

/// Whether a figure that is printed to `last_digit` is ours: within half of that digit and two standard
/// errors.
inline bool agrees(const estimate& ours, double printed, double last_digit) {
  const double error = std::isfinite(ours.standard_error) ? ours.standard_error : 0.0;
  return std::abs(ours.mean - printed) <= 0.5 * last_digit + 2.0 * error + 1e-12;
}

/// Whether a is below b by more than two standard errors.
inline bool is_below(const estimate& a, const estimate& b) {
  return b.mean - a.mean > 2.0 * std::hypot(a.standard_error, b.standard_error);
}

/// "0.4023 +- 0.0004": the error with two digits, and the value with as many places.
inline std::string with_error(const estimate& x) {
  if (!(x.standard_error > 0.0) || !std::isfinite(x.standard_error)) return fmt::format("{:.5g}", x.mean);
  const int places = 1 - static_cast<int>(std::floor(std::log10(x.standard_error)));
  const double size = std::abs(x.mean);
  if (places > 7 || places < 0 || size >= 1e5)
    return fmt::format("{:.3g} +- {:.1g}", x.mean, x.standard_error);
  return fmt::format("{:.{}f} +- {:.{}f}", x.mean, places, x.standard_error, places);
}

}  // namespace nysalt::program::paper
