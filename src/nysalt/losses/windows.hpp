// SPDX-License-Identifier: BSL-1.0
// Windows of trajectories of data, side by side in lanes, with their noise.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "nysalt/flow_map_data.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/noise.hpp"
#include "nysalt/noises/recorded_path.hpp"

namespace nysalt {

/// Windows of some consecutive trajectories, as many in each entry as R has lanes; the last one fills what
/// is left of the last entry.
template <Scalar R>
struct windows_in_lanes {
  static constexpr int N = Eigen::Dynamic;  ///< the dimension is known at run time
  /// One window in each lane.
  struct entry {
    phase_point<R, N> start;                ///< initial states of the windows
    std::vector<phase_point<R, N>> finish;  ///< states of the data at each time that counts
    std::vector<vector<R, N>> noise;        ///< noise of each letter O of the word, step after step
  };
  std::size_t first_trajectory;  ///< number of the trajectory of the first window, at this rank
  std::size_t begin;             ///< number of the first window, as in window_starts
  std::size_t end;               ///< number of the last window, plus one
  std::vector<entry> entries;    ///< all windows, lane by lane
};

/// The noise of entry m, as that of trajectory m of a run with that number of letters O a step. Refers to the
/// entries.
template <Scalar R>
struct noise_of_entries {
  static constexpr int N = Eigen::Dynamic;      ///< the dimension is known at run time
  static constexpr bool is_memoryless = false;  ///< the numbers are those of the data
  /// Entry m has the noise of trajectory m.
  const std::vector<typename windows_in_lanes<R>::entry>* entries = nullptr;
  std::int64_t letters = 0;  ///< letters O of a step

  /// The numbers of one letter O of one step into xi; T carries R, or derivatives over it.
  template <class T>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    const auto& all = (*entries)[static_cast<std::size_t>(at.trajectory)].noise;
    const auto& numbers = all[static_cast<std::size_t>(at.step * letters + at.flow)];
    for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] = T(numbers[i]);
  }
};

/// The noise in data that the letters O of a word need.
struct wanted_noise {
  detail::noise_intervals intervals;  ///< intervals of the letters O, in parts of the data
  double damping_of_part = 0;         ///< gamma times the length of a part
};

/// The pairs with which windows of a number of steps begin, trajectory by trajectory. first_of is as in
/// flow_map_data.
struct window_starts {
  std::vector<std::size_t> pairs;        ///< pairs with which windows begin
  std::vector<std::size_t> first_of{0};  ///< trajectory m has windows first_of[m] .. first_of[m + 1] - 1

  /// First pairs of the windows of `steps` steps that fit into trajectories of the data whose number, among
  /// those of all ranks, `every` divides, and begin `apart` steps apart.
  window_starts(const flow_map_data& data, std::size_t steps, std::size_t apart, std::int64_t every = 1) {
    for (std::size_t m = 0; m < data.trajectories(); ++m) {
      const bool counts = (data.share().first() + static_cast<std::int64_t>(m)) % every == 0;
      for (std::size_t pair = data.first_of[m]; counts && pair + steps <= data.first_of[m + 1];
           pair += apart) {
        pairs.push_back(pair);
      }
      first_of.push_back(pairs.size());
    }
  }
};

namespace detail {

template <Scalar R>
windows_in_lanes<R> gather_windows(const flow_map_data& data, const window_starts& starts,
                                   std::span<const int> after, const wanted_noise& wanted,
                                   std::size_t first_trajectory, std::size_t end_trajectory) {
  constexpr std::size_t width = lanes_in<R>;
  windows_in_lanes<R> result{
      first_trajectory, starts.first_of[first_trajectory], starts.first_of[end_trajectory], {}};
  const coarse_graining coarse(wanted.damping_of_part);
  const auto parts = static_cast<std::size_t>(data.noise_parts);
  const auto steps = static_cast<std::size_t>(after.back());
  for (std::size_t n = result.begin; n < result.end; n += width) {
    const auto pair = [&](std::size_t k) { return starts.pairs[std::min(n + k, result.end - 1)]; };
    const auto in_lanes = [&](const phase_points& states, std::size_t later) {
      return gather<R, Eigen::Dynamic>(lanes_in<R>, [&](int k) -> phase_point<double, Eigen::Dynamic> {
        return states[pair(static_cast<std::size_t>(k)) + later];
      });
    };
    result.entries.push_back({in_lanes(data.start, 0), {}, {}});
    for (const int k : after) {
      result.entries.back().finish.push_back(in_lanes(data.finish, static_cast<std::size_t>(k) - 1));
    }
    for (std::size_t step = 0; step < steps; ++step) {
      for (const auto& [begin, end] : wanted.intervals.of_letters) {
        vector<R, Eigen::Dynamic> noise(data.start.dimension());
        Eigen::VectorXd of_one(noise.size());
        for (std::size_t k = 0; k < width; ++k) {
          const std::size_t first = (pair(k) + step) * parts + static_cast<std::size_t>(begin);
          coarse.over(data.noise, first, static_cast<std::size_t>(end - begin), of_one);
          for (Eigen::Index i = 0; i < noise.size(); ++i) set_lane(noise[i], static_cast<int>(k), of_one[i]);
        }
        result.entries.back().noise.push_back(std::move(noise));
      }
    }
  }
  return result;
}

}  // namespace detail

/// All windows, with the data after these numbers of steps, in parts of whole trajectories that a thread
/// can take: of some thousand steps or more, so that lanes are left idle for one in a hundred at most.
template <Scalar R>
std::vector<windows_in_lanes<R>> gather_windows(const flow_map_data& data, const window_starts& starts,
                                                std::span<const int> after, const wanted_noise& wanted) {
  constexpr std::size_t enough = 1600;
  const auto is_part = [&](std::size_t windows) {
    const bool fills_lanes = windows % lanes_in<R> == 0;
    return windows >= enough || (fills_lanes && windows * static_cast<std::size_t>(after.back()) >= enough);
  };
  std::vector<windows_in_lanes<R>> result;
  for (std::size_t first = 0, end = 0; first < data.trajectories(); first = end) {
    do ++end;
    while (end < data.trajectories() && !is_part(starts.first_of[end] - starts.first_of[first]));
    result.push_back(detail::gather_windows<R>(data, starts, after, wanted, first, end));
  }
  return result;
}

}  // namespace nysalt
