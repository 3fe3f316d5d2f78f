// SPDX-License-Identifier: BSL-1.0
// Normal numbers without a state: each is a function of where it is used.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/noises/box_muller.hpp"
#include "nysalt/noises/philox.hpp"
#include "nysalt/phase_point.hpp"

namespace nysalt {

/// The purpose of a random number, so that no two uses share one.
enum class noise_purpose : std::uint8_t {
  initial_state = 1,   ///< initial state of a trajectory
  bath = 2,            ///< noise of the bath in a run
  bath_halves = 3,     ///< noise that splits a letter O into halves
  finer_path = 4,      ///< noise that splits a step of a path into halves
  burn_in = 5,         ///< noise of the run that makes an initial state
  burn_in_halves = 6,  ///< noise that splits letters O of that run
  search = 7,          ///< random starts of a search
  perturbation = 8,    ///< perturbation of a start
  momenta = 9,         ///< momenta of a trajectory of Hybrid Monte Carlo, and whether it is accepted
  duration = 10        ///< durations of trajectories of Hybrid Monte Carlo
};

/// Index of random numbers. A slot holds two of them: a step that needs N numbers k times gives
/// slots_for(N) slots to each time.
struct noise_counter {
  std::uint64_t trajectory = 0;  ///< below 2^48
  std::int64_t step = 0;         ///< step number, 0 <= step < 2^48
  std::uint64_t slot = 0;        ///< below 2^24
  noise_purpose purpose{};       ///< purpose of the numbers
};

/// The number of slots that hold n numbers.
constexpr std::uint64_t slots_for(std::uint64_t numbers) { return numbers / 2 + numbers % 2; }

namespace detail {

/// Throws std::invalid_argument if a trajectory, the step or a slot does not fit into the counter.
inline void check_counter(const noise_counter& first, std::uint64_t trajectories, std::uint64_t slots) {
  constexpr std::uint64_t two_to_48 = std::uint64_t{1} << 48U;
  constexpr std::uint64_t two_to_24 = std::uint64_t{1} << 24U;
  if (first.trajectory > two_to_48 - trajectories) {
    throw std::invalid_argument(
        sentence("standard_normals: trajectory must be < 2^48, got {}", first.trajectory));
  }
  if (first.step < 0 || first.step >= static_cast<std::int64_t>(two_to_48)) {
    throw std::invalid_argument(
        sentence("standard_normals: step must be >= 0 and < 2^48, got {}", first.step));
  }
  if (slots > two_to_24 || first.slot > two_to_24 - slots) {
    throw std::invalid_argument(
        sentence("standard_normals: slots of a step must be < 2^24, got {} slots from slot {}; use "
                 "fewer numbers a step",
                 slots, first.slot));
  }
}

/// Count lanes from the first on of one pack become lanes of another, or a double, which has one lane.
template <class T>
[[gnu::always_inline]] inline void copy_lanes(const pack<double>& from, int first, int count, T& to,
                                              int to_first) {
  constexpr int of_part = pack<double>::of_part;
  const int end = std::min(count, lanes_in<T> - to_first);
  if constexpr (lanes_in<T> % of_part == 0) {  // whole registers
    for (int k = 0; k < end; k += of_part) {
      to.parts[static_cast<std::size_t>((to_first + k) / of_part)] =
          from.parts[static_cast<std::size_t>((first + k) / of_part)];
    }
  } else {
    for (int k = 0; k < end; ++k) set_lane(to, to_first + k, from[first + k]);
  }
}

/// The pairs of some slots, each with one trajectory in each lane, become the numbers from the first
/// on.
template <int Trajectories, class T>
[[gnu::always_inline]] inline void copy_pairs(const std::array<pack<double>, 2>& pairs, std::span<T> out,
                                              std::size_t first, int lane) {
  for (int k = 0; k < words::lanes; k += Trajectories) {
    for (const auto& numbers : pairs) {
      if (first < out.size()) copy_lanes(numbers, k, Trajectories, out[first], lane);
      ++first;
    }
  }
}

}  // namespace detail

/// Independent standard normal numbers, a pure function of seed and counter, independent of T, of the number
/// of numbers and of the order of calls: Philox 4x32-10 with the seed as its key [salmon_2011], then Box and
/// Muller's formula on uniform numbers of 52 bits. out[i] is number i % 2 of slot first.slot + i/2; lane l of
/// a pack belongs to trajectory first.trajectory + l. The counter's words of 32 bits are
///   trajectory mod 2^32,  trajectory div 2^32 + 2^16 (step div 2^32),  step mod 2^32,  slot + 2^24 purpose.
/// T is double or pack<double, W>. Least cost a number: pack<double>, or double if there are many. Throws
/// std::invalid_argument if trajectory, step or slot are out of range.
template <class T>
  requires std::same_as<T, double> || is_pack<T>
[[gnu::noinline]] void standard_normals(std::uint64_t seed, const noise_counter& first, std::span<T> out) {
  using detail::words;
  constexpr int lanes = lanes_in<T>;
  // All lanes of words are filled: with trajectories, and with several slots if these are few.
  constexpr int trajectories = std::min(static_cast<int>(std::bit_ceil(unsigned{lanes})), words::lanes);
  constexpr int slots = words::lanes / trajectories;
  constexpr std::size_t most = 8;  // registers at a time: more than the processor reorders
  const std::uint64_t needed = slots_for(out.size());
  detail::check_counter(first, lanes, needed);

  const auto step = static_cast<std::uint64_t>(first.step);
  const std::uint64_t purpose = std::uint64_t{static_cast<std::uint8_t>(first.purpose)} << 24U;
  const words number = words::lane_numbers();
  for (int lane = 0; lane < lanes; lane += trajectories) {
    const words trajectory =
        (number & (trajectories - 1)) + (first.trajectory + static_cast<std::uint64_t>(lane));
    const words slot = (number >> std::countr_zero(unsigned{trajectories})) + first.slot;
    const words upper = (trajectory >> 32) | ((step >> 32U) << 16U);
    for (std::uint64_t done = 0; done < needed; done += most * slots) {
      const std::size_t count = std::min<std::size_t>(most, (needed - done + slots - 1) / slots);
      std::array<std::array<words, 2>, most> bits;
      std::array<pack<double>, most> squared_distance;
      for (std::size_t i = 0; i < count; ++i) {
        bits[i] = detail::philox({trajectory, upper, step, (slot + (done + i * slots)) | purpose}, seed);
      }
      for (std::size_t i = 0; i < count; ++i) squared_distance[i] = detail::squared_distance(bits[i][0]);
      for (std::size_t i = 0; i < count; ++i) {
        detail::copy_pairs<trajectories>(detail::normal_pair(squared_distance[i], bits[i][1]), out,
                                         2 * (done + i * slots), lane);
      }
    }
  }
}

/// Writes standard normals into a vector.
template <class T, int N>
void standard_normals(std::uint64_t seed, const noise_counter& first, vector<T, N>& out) {
  standard_normals<T>(seed, first, std::span<T>(out.data(), static_cast<std::size_t>(out.size())));
}

}  // namespace nysalt
