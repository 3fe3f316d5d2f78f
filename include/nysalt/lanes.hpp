// SPDX-License-Identifier: BSL-1.0
// Trajectories side by side in the lanes of packs: how many, and one of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include "nysalt/energy.hpp"
#include "nysalt/scalars/pack.hpp"

namespace nysalt {

namespace detail {

/// The scalar of W lanes: a pack, or plain double for W = 1.
template <int W>
using scalar_of_lanes = std::conditional_t<W == 1, double, pack<double, std::max(W, 1)>>;

template <System S>
constexpr int most_lanes() {
  if constexpr (requires { S::lanes; }) {
    static_assert(S::lanes >= 1 && S::lanes <= 16, "nysalt: lanes of a system must lie in 1..16");
    return S::lanes;
  } else {
    return default_lanes;
  }
}
/// A kinetic energy of its own must serve the scalar too.
template <class S, class T>
concept DriftsOver = (!HasVelocity<S, double> && !HasKineticEnergy<S, double>) || HasVelocity<S, T> ||
                     HasKineticEnergy<S, dual<T, sweep<S::dimension>>>;

/// Trajectories of this system that are stepped at a time: as many as suit the processor, or
/// `static constexpr int lanes` of the system; one if its force is known for double only.
template <System S>
inline constexpr int lanes_of = [] {
  constexpr int most = detail::most_lanes<S>();
  using T = scalar_of_lanes<most>;
  if constexpr (SystemOver<S, T> && detail::DriftsOver<S, T>) return most;
  return 1;
}();

}  // namespace detail

/// Trajectories that a scalar holds: the lanes of a pack, else one.
template <class T>
inline constexpr int lanes_in = 1;
template <int W>
inline constexpr int lanes_in<pack<double, W>> = W;  ///< number of lanes

namespace detail {

/// The type of a comparison of two T: a bool, or a mask of lanes.
template <class T>
using condition_of = decltype(T(0.0) < T(0.0));

}  // namespace detail

// One code for double, which has one lane, and for packs.
inline double lane(double x, int) { return x; }  ///< value of the only lane
inline bool lane(bool x, int) { return x; }      ///< value of the only lane
namespace detail {

inline void set_lane(double& x, int, double value) { x = value; }  ///< assigns the only lane
inline void set_lane(bool& x, int, bool value) { x = value; }      ///< assigns the only lane

}  // namespace detail
/// The number in lane k.
template <int W>
double lane(const pack<double, W>& x, int k) {
  return x[k];
}
/// Whether lane k is set.
template <int W>
bool lane(const detail::lane_mask<W>& x, int k) {
  return x[k];
}
namespace detail {

/// Puts a number into lane k.
template <int W>
void set_lane(pack<double, W>& x, int k, double value) {
  x.set(k, value);
}
/// Sets or clears lane k.
template <int W>
void set_lane(detail::lane_mask<W>& x, int k, bool value) {
  x.set(k, value);
}

inline bool both(bool a, bool b) { return a && b; }  ///< a and b
/// The lanes in which both hold.
template <int W>
detail::lane_mask<W> both(const detail::lane_mask<W>& a, const detail::lane_mask<W>& b) {
  return a & b;
}

/// f of the scalar that holds as many trajectories as the system takes side by side.
template <System S>
decltype(auto) with_scalar_of(const S& system, const auto& f) {
  if constexpr (ErasedSystem<S>) {
    if (!system.facts().in_lanes) return f(double{});
  }
  return f(scalar_of_lanes<lanes_of<S>>{});
}
}  // namespace detail

/// The vector of the trajectory in lane k.
template <class T, int N>
vector<double, N> lane(const vector<T, N>& x, int k) {
  vector<double, N> result(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) result[i] = lane(x[i], k);
  return result;
}
/// The state of the trajectory in lane k.
template <class T, int N>
phase_point<double, N> lane(const phase_point<T, N>& x, int k) {
  phase_point<double, N> result{vector<double, N>(x.size()), vector<double, N>(x.size())};
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    result.q[i] = lane(x.q[i], k);
    result.p[i] = lane(x.p[i], k);
  }
  return result;
}
namespace detail {

/// Puts a state into lane k.
template <class T, int N>
void set_lane(phase_point<T, N>& x, int k, const phase_point<double, N>& value) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    set_lane(x.q[i], k, value.q[i]);
    set_lane(x.p[i], k, value.p[i]);
  }
}

/// The lanes 0..count - 1.
template <class T>
condition_of<T> first_lanes(int count) {
  condition_of<T> result(false);
  for (int k = 0; k < count; ++k) set_lane(result, k, true);
  return result;
}

/// States 0..count - 1 from make(k), one in each lane; lanes beyond them repeat the first.
template <class T, int N>
phase_point<T, N> gather(int count, const auto& make) {
  phase_point<T, N> result = make(0).template cast<T>();
  for (int k = 1; k < std::min(count, lanes_in<T>); ++k) set_lane(result, k, make(k));
  return result;
}

}  // namespace detail

/// Mask of the lanes in which all of q and p are finite: x - x is 0 there, and NaN elsewhere.
template <int W, int N>
detail::lane_mask<W> is_finite(const phase_point<pack<double, W>, N>& x) {
  pack<double, W> sum(0.0);
  for (Eigen::Index i = 0; i < x.size(); ++i) sum += (x.q[i] - x.q[i]) + (x.p[i] - x.p[i]);
  return sum == 0.0;
}

/// A function of a state that takes packs as well as double: it is called once for all lanes.
template <class F>
struct over_lanes : F {
  explicit over_lanes(F f) : F(std::move(f)) {}
};

namespace detail {
template <class F>
inline constexpr bool takes_lanes = false;
template <class F>
inline constexpr bool takes_lanes<over_lanes<F>> = true;
}  // namespace detail

/// f(x) in each lane. What takes double is called with packs only if it is marked by over_lanes: of a lambda
/// with `auto` no concept decides whether it compiles for them.
template <class T, class F, int N>
T value_in_lanes(const F& f, const phase_point<T, N>& x) {
  using one_lane = phase_point<double, N>;
  if constexpr (detail::takes_lanes<F> || !std::is_invocable_v<const F&, const one_lane&> ||
                std::is_same_v<T, double>) {
    return f(x);
  } else {
    T result(0.0);
    for (int k = 0; k < lanes_in<T>; ++k) detail::set_lane(result, k, f(lane(x, k)));
    return result;
  }
}

namespace detail {

/// The number of the first sample, or step, at which a condition held in each lane.
template <class T>
class first_in_lanes {
 public:
  /// Takes the condition at number n; numbers come in ascending order.
  void take(const condition_of<T>& holds, std::int64_t n) {
    if (!any(holds)) return;
    for (int k = 0; k < lanes_in<T>; ++k) {
      auto& first = first_[static_cast<std::size_t>(k)];
      if (lane(holds, k) && !first) first = n;
    }
  }
  /// Forgets the lanes in which a condition holds.
  void reset(const condition_of<T>& holds) {
    if (!any(holds)) return;
    for (int k = 0; k < lanes_in<T>; ++k) {
      if (lane(holds, k)) first_[static_cast<std::size_t>(k)].reset();
    }
  }
  void set(int k, std::optional<std::int64_t> n) {
    first_[static_cast<std::size_t>(k)] = n;
  }  ///< assigns lane k
  /// Value of lane k; empty if the condition never held there.
  const std::optional<std::int64_t>& operator[](int k) const { return first_[static_cast<std::size_t>(k)]; }

 private:
  std::array<std::optional<std::int64_t>, static_cast<std::size_t>(lanes_in<T>)> first_{};
};

/// H in each lane, also where the potential is known for double only.
template <class T, HasEnergy S>
T energy_in_lanes(const S& system, const phase_point<T, S::dimension>& x) {
  if constexpr (HasEnergy<S, T>) {
    return energy<T>(system, x);
  } else {
    return value_in_lanes<T>([&](const auto& y) { return energy<double>(system, y); }, x);
  }
}

}  // namespace detail

}  // namespace nysalt
