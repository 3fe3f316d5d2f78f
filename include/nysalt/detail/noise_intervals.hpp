// SPDX-License-Identifier: BSL-1.0
// The part of a step that each letter O of a word covers.
#pragma once

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "nysalt/detail/sentence.hpp"

namespace nysalt {

/// From begin to end, in equal parts of a step.
struct noise_interval {
  int begin;  ///< the first part of it
  int end;    ///< the first part behind it
  /// Whether both ends are the same.
  friend bool operator==(const noise_interval&, const noise_interval&) = default;
};

/// The letters O share the step in their order: each covers as much as its coefficient says. `parts` is the
/// least number of equal parts such that none is cut; 0 where there is no letter O.
struct noise_intervals {
  int parts = 0;                           ///< of the step, all equal
  std::vector<noise_interval> of_letters;  ///< one for each letter O, in their order

  /// The same in a multiple of the parts.
  noise_intervals in_parts(int more) const {
    noise_intervals result{more, {}};
    for (const auto& [begin, end] : of_letters) {
      result.of_letters.push_back({begin * (more / parts), end * (more / parts)});
    }
    return result;
  }
};

/// Of a word whose letters O have these coefficients. Throws std::invalid_argument unless they cover the step
/// once, forwards, in at most 60 equal parts.
inline noise_intervals intervals_of_noise(std::string_view letters, const std::vector<double>& coefficients) {
  constexpr int most_parts = 60;
  std::vector<double> ends{0.0};
  for (const double c : coefficients) {
    if (c < 0.0) {
      throw std::invalid_argument(sentence(
          "the word {}: coefficients of letters O must be >= 0, as noise goes forward in time, got {}",
          letters, c));
    }
    ends.push_back(ends.back() + c);
  }
  if (ends.size() == 1) return {};
  constexpr double rounding = 1e-9;  // coefficients are typed with ten digits or more
  if (!(std::abs(ends.back() - 1.0) <= rounding)) {
    throw std::invalid_argument(
        sentence("the letters O of {} must cover one step, so that the noise is that of a path, got {}",
                 letters, ends.back()));
  }
  for (int parts = 1; parts <= most_parts; ++parts) {
    noise_intervals result{parts, {}};
    for (std::size_t k = 1; k < ends.size(); ++k) {
      const auto at = [&](double end) { return std::round(end * parts); };
      if (!(std::abs(ends[k] * parts - at(ends[k])) <= rounding * parts)) break;
      result.of_letters.push_back({static_cast<int>(at(ends[k - 1])), static_cast<int>(at(ends[k]))});
    }
    if (result.of_letters.size() + 1 == ends.size()) return result;
  }
  throw std::invalid_argument(
      sentence("the letters O of {} must divide a step into equal parts, {} at most", letters, most_parts));
}

}  // namespace nysalt
