// SPDX-License-Identifier: BSL-1.0
// Sources of the noise of a bath, and the intervals of a path that letters O take.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/phase_point.hpp"

namespace nysalt {

namespace detail {

/// The letter of the bath in words.
inline constexpr char bath_letter = 'O';

}  // namespace detail

/// Position of noise in a run: the letter O that is number `flow` among the letters O of the word, in the
/// step from `step` to `step` + 1 of a trajectory. Lane l of a pack belongs to trajectory + l.
struct noise_place {
  std::uint64_t trajectory = 0;  ///< trajectory number, of lane 0
  std::int64_t step = 0;         ///< step number, from 0
  int flow = 0;                  ///< number of the letter O in the word, from 0
};

// clang-format off
/// A source of standard normal numbers for the letters O of a run:
/// normals(place, xi)      for xi of the states that are stepped: xi_i become the standard normal numbers of
///                         that place, a pure function of it
/// is_memoryless           true: numbers depend on no earlier ones; the halves of a letter O in which one
///                         step ends and the next begins become one, and
/// halving(place, zeta)    are further ones, independent of the first, from which the halves are computed
///                         when they are observed. false: they belong to a path, which has its own halves
// clang-format on
template <class N>
concept NoiseSource = std::copyable<N> && requires {
  { N::is_memoryless } -> std::convertible_to<bool>;
};

/// A noise source for runs without noise: no letter O, or a bath with sigma = 0. A stepper refuses it
/// otherwise.
struct no_noise {
  static constexpr bool is_memoryless = false;

  template <class T, int N>
  void normals(const noise_place&, vector<T, N>&) const {}
};

// The part of a step that each letter O of a word covers.

namespace detail {

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

}  // namespace detail

}  // namespace nysalt
