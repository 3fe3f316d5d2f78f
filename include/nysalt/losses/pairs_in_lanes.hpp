// SPDX-License-Identifier: BSL-1.0
// Pairs of states side by side in the lanes of a scalar, gathered once for many passes over the data.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/noise_intervals.hpp"
#include "nysalt/noises/recorded_path.hpp"

namespace nysalt {

/// What passes over data compute with: packs where the system serves them and their derivatives, else double.
template <Family F, System S>
using scalar_of_passes = std::conditional_t<SystemOver<S, dual<scalar_of_lanes<lanes_of<S>>, F::parameters>>,
                                            scalar_of_lanes<lanes_of<S>>, double>;

/// The pairs begin .. end - 1 of some consecutive trajectories, as many in each entry as R has lanes; the
/// last pair fills what is left of the last entry.
template <Scalar R, int N>
struct pairs_in_lanes {
  struct entry {
    phase_point<R, N> start;
    phase_point<R, N> finish;
    std::vector<vector<R, N>> noise;  // that of each letter O of the word
  };
  std::size_t first_trajectory;
  std::size_t begin;
  std::size_t end;
  std::vector<entry> entries;
};

/// The noise of entry n, as that of step n of a run. Refers to the entries.
template <Scalar R, int N>
struct noise_of_entries {
  static constexpr bool draws_freely = false;
  const std::vector<typename pairs_in_lanes<R, N>::entry>* entries = nullptr;

  template <class T>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    const auto& its = (*entries)[static_cast<std::size_t>(at.step)].noise[static_cast<std::size_t>(at.flow)];
    for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] = T(its[i]);
  }
};

/// What the letters O of a word need of the noise in data.
struct wanted_noise {
  noise_intervals intervals;   // in the parts of the data
  double damping_of_part = 0;  // gamma times the length of a part
};

namespace detail {

template <Scalar R, int N>
pairs_in_lanes<R, N> gather_pairs(const flow_map_data<N>& data, const wanted_noise& wanted,
                                  std::size_t first_trajectory, std::size_t end_trajectory) {
  constexpr std::size_t width = lanes_in<R>;
  pairs_in_lanes<R, N> result{
      first_trajectory, data.first_of[first_trajectory], data.first_of[end_trajectory], {}};
  const coarse_graining coarse(wanted.damping_of_part);
  const auto parts = static_cast<std::size_t>(data.noise_parts);
  for (std::size_t pair = result.begin; pair < result.end; pair += width) {
    const auto in_lanes = [&](const std::vector<phase_point<double, N>>& states) {
      return gather<R, N>(lanes_in<R>, [&](int k) {
        return states[std::min(pair + static_cast<std::size_t>(k), result.end - 1)];
      });
    };
    result.entries.push_back({in_lanes(data.start), in_lanes(data.finish), {}});
    for (const auto& [begin, end] : wanted.intervals.of_letters) {
      vector<R, N> noise(data.start[pair].size());
      vector<double, N> of_one(noise.size());
      for (std::size_t k = 0; k < width; ++k) {
        const std::size_t first =
            std::min(pair + k, result.end - 1) * parts + static_cast<std::size_t>(begin);
        coarse.over(std::span(data.noise).subspan(first, static_cast<std::size_t>(end - begin)), of_one);
        for (Eigen::Index i = 0; i < noise.size(); ++i) set_lane(noise[i], static_cast<int>(k), of_one[i]);
      }
      result.entries.back().noise.push_back(std::move(noise));
    }
  }
  return result;
}

}  // namespace detail

/// All pairs, in parts of whole trajectories that a thread can take: of a thousand pairs or more, so that
/// lanes are left idle for one pair in a hundred at most.
template <Scalar R, int N>
std::vector<pairs_in_lanes<R, N>> gather_pairs(const flow_map_data<N>& data, const wanted_noise& wanted) {
  constexpr std::size_t enough = 1600;
  std::vector<pairs_in_lanes<R, N>> result;
  for (std::size_t first = 0, end = 0; first < data.trajectories(); first = end) {
    while (end < data.trajectories() && data.first_of[end] - data.first_of[first] < enough) ++end;
    result.push_back(detail::gather_pairs<R>(data, wanted, first, end));
  }
  return result;
}

}  // namespace nysalt
