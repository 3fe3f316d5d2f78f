// SPDX-License-Identifier: BSL-1.0
// Pairs of states side by side in the lanes of a scalar, gathered once for many passes over the data.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/scalars/pack.hpp"

namespace nysalt {

namespace detail {

// Lanes of a scalar: a double is one.
template <class R>
inline constexpr int lanes = 1;
template <int W>
inline constexpr int lanes<pack<double, W>> = W;

inline double in_lane(double x, int) { return x; }
template <int W>
double in_lane(const pack<double, W>& x, int lane) {
  return x[lane];
}
inline void set_lane(double& x, int, double value) { x = value; }
template <int W>
void set_lane(pack<double, W>& x, int lane, double value) {
  x.set(lane, value);
}

/// Serves packs: a black box does not, nor who says `static constexpr int lanes = 1;`.
template <class S>
concept OneLane = requires {
  requires S::lanes == 1;
};
template <class S, int P>
concept ServesPacks = !OneLane<S> && SystemOver<S, dual<pack<double, default_lanes>, P>>;

template <class F, class S>
struct scalar_of_passes {
  using type = double;
};
template <class F, class S>
  requires ServesPacks<S, F::parameters>
struct scalar_of_passes<F, S> {
  using type = pack<double, default_lanes>;
};

}  // namespace detail

/// What passes over data compute with: packs where the system serves them, else double.
template <Family F, System S>
using scalar_of_passes = typename detail::scalar_of_passes<F, S>::type;

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
void put_in_lane(phase_point<R, N>& to, int lane, const phase_point<double, N>& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    set_lane(to.q[i], lane, x.q[i]);
    set_lane(to.p[i], lane, x.p[i]);
  }
}

template <Scalar R, int N>
pairs_in_lanes<R, N> gather(const flow_map_data<N>& data, std::size_t first_trajectory,
                            std::size_t end_trajectory) {
  constexpr auto width = static_cast<std::size_t>(lanes<R>);
  const std::size_t begin = data.first_of[first_trajectory];
  const std::size_t end = data.first_of[end_trajectory];
  const std::size_t pairs = end - begin;
  const Eigen::Index n = data.start.front().size();
  const phase_point<R, N> blank{vector<R, N>(n), vector<R, N>(n)};
  pairs_in_lanes<R, N> result{first_trajectory, begin, end, {}};
  result.entries.resize((pairs + width - 1) / width, {blank, blank});
  for (std::size_t i = 0; i < result.entries.size() * width; ++i) {
    const std::size_t pair = begin + std::min(i, pairs - 1);
    const int lane = static_cast<int>(i % width);
    put_in_lane(result.entries[i / width].start, lane, data.start[pair]);
    put_in_lane(result.entries[i / width].finish, lane, data.finish[pair]);
  }
  return result;
}

}  // namespace detail

/// All pairs, in parts of whole trajectories that a thread can take: of a thousand pairs or more, so that
/// lanes are left idle for one pair in a hundred at most.
template <Scalar R, int N>
std::vector<pairs_in_lanes<R, N>> gather(const flow_map_data<N>& data) {
  constexpr std::size_t enough = 1600;
  std::vector<pairs_in_lanes<R, N>> result;
  for (std::size_t first = 0, end = 0; first < data.trajectories(); first = end) {
    while (end < data.trajectories() && data.first_of[end] - data.first_of[first] < enough) ++end;
    result.push_back(detail::gather<R>(data, first, end));
  }
  return result;
}

}  // namespace nysalt
