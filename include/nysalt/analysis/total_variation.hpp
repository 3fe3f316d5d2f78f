// SPDX-License-Identifier: BSL-1.0
// How far apart two distributions are, and how far two samples of one would be.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>

#include "nysalt/analysis/histogram.hpp"

namespace nysalt {

/// 1/2 sum_i |p_i - q_i| over all bins, those below and above too: between 0 and 1.
/// Throws std::invalid_argument if the bins differ or one of the two is empty.
inline double total_variation(const histogram& a, const histogram& b) {
  a.require_bins_of(b);
  const auto p = a.fractions();
  const auto q = b.fractions();
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += std::abs(p[i] - q[i]);
  return 0.5 * sum;
}

/// The mean distance of one histogram to those of independent ensembles: what compares with sampling_floor
/// of the same ensembles, if all have as many trajectories and samples.
/// Throws std::invalid_argument if there is no ensemble, and like total_variation.
inline double mean_total_variation(const histogram& given, std::span<const histogram> ensembles) {
  if (ensembles.empty())
    throw std::invalid_argument("mean_total_variation: there is nothing to compare with");
  double sum = 0.0;
  for (const histogram& other : ensembles) sum += total_variation(given, other);
  return sum / static_cast<double>(ensembles.size());
}

/// The mean distance over all pairs of independent ensembles of one law: the distance that sampling alone
/// makes. With n independent numbers in each, it is about sum_i sqrt(p_i (1 - p_i)/(pi n)).
/// Throws std::invalid_argument unless there are 4 ensembles at least (three have only 3 pairs).
inline double sampling_floor(std::span<const histogram> ensembles) {
  if (ensembles.size() < 4) {
    throw std::invalid_argument(fmt::format(
        "sampling_floor: {} independent ensembles are too few, take 4 at least (6 pairs)", ensembles.size()));
  }
  double sum = 0.0;
  double pairs = 0.0;
  for (std::size_t i = 0; i < ensembles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      sum += total_variation(ensembles[i], ensembles[j]);
      pairs += 1.0;
    }
  }
  return sum / pairs;
}

}  // namespace nysalt
