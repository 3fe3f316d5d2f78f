// SPDX-License-Identifier: BSL-1.0
// When a ratio holds, when it does not, and when the machine is too noisy to say.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "measurements.hpp"

namespace nysalt::bench {

/// The median of paired ratios and what they scatter.
struct ratio {
  double value = 0.0;
  double low = 0.0;  // the median is between low and high, with a confidence of 95 %
  double high = 0.0;
  double spread = 0.0;  // distance of the quartiles, relative to the median
  double least = 0.0;
  double largest = 0.0;
  std::size_t pairs = 0;
};

/// Of over[i]/under[i], each pair from one round. Throws std::runtime_error if there are none.
inline ratio paired_ratio(const samples& over, const samples& under) {
  if (over.size() != under.size() || over.empty()) throw std::runtime_error("a ratio needs pairs");
  samples r(over.size());
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = over[i] / under[i];
  std::sort(r.begin(), r.end());
  const auto n = static_cast<double>(r.size());
  // How many of n lie below the median is binomial: n/2 +- 1.96 sqrt(n)/2, whatever their distribution.
  const double outside = std::floor(0.5 * (n - 1.96 * std::sqrt(n)));
  const auto j = static_cast<std::size_t>(std::max(outside - 1.0, 0.0));
  const double middle = median(r);
  const double quartiles = r[(3 * r.size()) / 4] - r[r.size() / 4];
  return {middle, r[j], r[r.size() - 1 - j], quartiles / middle, r.front(), r.back(), r.size()};
}

/// A ratio is to be at least or at most so much.
struct target {
  bool at_least;
  double bound;

  bool met_by(double value) const { return at_least ? value >= bound : value <= bound; }
};

struct verdict {
  std::optional<bool> holds;
  std::string reason{};  // if nothing can be said
};

/// Beyond this the quartiles of what should be one number are so far apart that its median says little.
inline constexpr double largest_spread = 0.2;

/// Holds or does not if the whole confidence interval is on one side of the target. Where the spread is too
/// large, every single pair must be.
inline verdict judge(const ratio& found, const target& wanted) {
  if (found.spread > largest_spread && wanted.met_by(found.least) != wanted.met_by(found.largest)) {
    return {std::nullopt,
            fmt::format("too noisy: the quartiles of {} pairs are {:.0f} % apart, and the pairs on both "
                        "sides of the target",
                        found.pairs, 100.0 * found.spread)};
  }
  if (wanted.met_by(found.low) != wanted.met_by(found.high)) {
    return {std::nullopt, fmt::format("too noisy: the median of {} pairs is between {:.4g} and {:.4g}",
                                      found.pairs, found.low, found.high)};
  }
  return {wanted.met_by(found.value)};
}

}  // namespace nysalt::bench
