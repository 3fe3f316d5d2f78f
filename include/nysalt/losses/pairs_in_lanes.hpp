// SPDX-License-Identifier: BSL-1.0
// Pairs of states side by side in the lanes of a scalar, gathered once for many passes over the data.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/lanes.hpp"

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
  };
  std::size_t first_trajectory;
  std::size_t begin;
  std::size_t end;
  std::vector<entry> entries;
};

namespace detail {

template <Scalar R, int N>
pairs_in_lanes<R, N> gather_pairs(const flow_map_data<N>& data, std::size_t first_trajectory,
                                  std::size_t end_trajectory) {
  constexpr std::size_t width = lanes_in<R>;
  pairs_in_lanes<R, N> result{
      first_trajectory, data.first_of[first_trajectory], data.first_of[end_trajectory], {}};
  for (std::size_t pair = result.begin; pair < result.end; pair += width) {
    const auto in_lanes = [&](const std::vector<phase_point<double, N>>& states) {
      return gather<R, N>(lanes_in<R>, [&](int k) {
        return states[std::min(pair + static_cast<std::size_t>(k), result.end - 1)];
      });
    };
    result.entries.push_back({in_lanes(data.start), in_lanes(data.finish)});
  }
  return result;
}

}  // namespace detail

/// All pairs, in parts of whole trajectories that a thread can take: of a thousand pairs or more, so that
/// lanes are left idle for one pair in a hundred at most.
template <Scalar R, int N>
std::vector<pairs_in_lanes<R, N>> gather_pairs(const flow_map_data<N>& data) {
  constexpr std::size_t enough = 1600;
  std::vector<pairs_in_lanes<R, N>> result;
  for (std::size_t first = 0, end = 0; first < data.trajectories(); first = end) {
    while (end < data.trajectories() && data.first_of[end] - data.first_of[first] < enough) ++end;
    result.push_back(detail::gather_pairs<R>(data, first, end));
  }
  return result;
}

}  // namespace nysalt
