// SPDX-License-Identifier: BSL-1.0
// W numbers side by side, one for each of W trajectories, computed with the processor's own vectors.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

#include "nysalt/scalar.hpp"
#include "nysalt/scalars/lane_mask.hpp"

namespace nysalt {

/// W lanes of T = double. Every operation acts lane by lane and rounds as it does for double, so that lane k
/// of a step over packs has the bits of a step over double. Elementary functions but sqrt are libm's, one
/// lane after the other. A double next to a pack means the same value in all lanes.
template <class T, int W = default_lanes>
  requires(std::same_as<T, double> && 1 <= W && W <= 16)
class pack {
 public:
  static constexpr int lanes = W;                              ///< number of lanes
  static constexpr int of_part = detail::lanes_of_part(W);     ///< lanes in a register of the target
  using part = typename detail::native_vector<of_part>::type;  ///< a register
  using mask = lane_mask<W>;                                   ///< result of comparing two packs

  pack() = default;
  /// A pack with one number in all lanes; the sign of zero is kept.
  pack(double all) {
    for (part& mine : parts) mine = all - part{};  // - keeps the sign of zero
  }

  /// The number in lane 0 <= lane < W; not checked.
  double operator[](int lane) const {
    if constexpr (of_part == 1) {
      return parts[static_cast<std::size_t>(lane)];
    } else {
      return parts[static_cast<std::size_t>(lane / of_part)][lane % of_part];
    }
  }
  /// Assigns lane 0 <= lane < W; unchecked.
  void set(int lane, double value) {
    if constexpr (of_part == 1) {
      parts[static_cast<std::size_t>(lane)] = value;
    } else {
      parts[static_cast<std::size_t>(lane / of_part)][lane % of_part] = value;
    }
  }

  pack& operator+=(const pack& b) { return *this = *this + b; }
  pack& operator-=(const pack& b) { return *this = *this - b; }
  pack& operator*=(const pack& b) { return *this = *this * b; }
  pack& operator/=(const pack& b) { return *this = *this / b; }

  friend pack operator+(const pack& a, const pack& b) {
    return each(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x + y; });
  }
  friend pack operator-(const pack& a, const pack& b) {
    return each(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x - y; });
  }
  friend pack operator*(const pack& a, const pack& b) {
    return each(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x * y; });
  }
  friend pack operator/(const pack& a, const pack& b) {
    return each(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x / y; });
  }
  friend pack operator-(const pack& a) {
    return each(
        a, a, [](part x, part) __attribute__((always_inline)) { return -x; });
  }

  friend mask operator<(const pack& a, const pack& b) {
    return compare(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x < y; });
  }
  friend mask operator<=(const pack& a, const pack& b) {
    return compare(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x <= y; });
  }
  friend mask operator>(const pack& a, const pack& b) { return b < a; }
  friend mask operator>=(const pack& a, const pack& b) { return b <= a; }
  friend mask operator==(const pack& a, const pack& b) {
    return compare(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x == y; });
  }
  friend mask operator!=(const pack& a, const pack& b) {
    return compare(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x != y; });
  }

  /// a in the lanes `which`, b in the others; both have been evaluated.
  friend pack select(const mask& which, const pack& a, const pack& b) {
    pack result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) {
      result.parts[i] = which.parts[i] ? a.parts[i] : b.parts[i];
    }
    return result;
  }

  std::array<part, W / of_part> parts;  ///< lane k is in parts[k / of_part]

 private:
  [[gnu::always_inline]] static pack each(const pack& a, const pack& b, auto f) {
    pack result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = f(a.parts[i], b.parts[i]);
    return result;
  }
  [[gnu::always_inline]] static mask compare(const pack& a, const pack& b, auto f) {
    mask result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = f(a.parts[i], b.parts[i]);
    return result;
  }
};

// Vectors of packs are Eigen's, so Eigen must align what it allocates as the registers want it.
static_assert(
    alignof(pack<double>) <= EIGEN_DEFAULT_ALIGN_BYTES || alignof(pack<double>) <= 16,
    "nysalt: Eigen aligns for less than a register of this target: define EIGEN_MAX_ALIGN_BYTES=64");

/// Whether a type is a pack of any width.
template <class T>
inline constexpr bool is_pack = false;
template <class T, int W>
inline constexpr bool is_pack<pack<T, W>> = true;  ///< a pack is one
template <class T, int W>
inline constexpr bool has_functions<pack<T, W>> = true;  ///< below

/// Square root, rounded to nearest, as IEEE 754 asks, and in one instruction for a register.
template <int W>
pack<double, W> sqrt(const pack<double, W>& a) {
  pack<double, W> result;
  for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = detail::native_sqrt(a.parts[i]);
  return result;
}
template <int W>
pack<double, W> abs(const pack<double, W>& a) {
  return select(a < 0.0, -a, a + 0.0);  // + 0.0: that of -0 is 0
}

namespace detail {
/// f of each lane: the bits of f over double.
template <int W>
[[gnu::always_inline]] inline pack<double, W> by_lane(const pack<double, W>& a, auto f) {
  pack<double, W> result;
  for (int lane = 0; lane < W; ++lane) result.set(lane, f(a[lane]));
  return result;
}
/// f of each lane of both: the bits of f over double.
template <int W>
[[gnu::always_inline]] inline pack<double, W> by_lane(const pack<double, W>& a, const pack<double, W>& b,
                                                      auto f) {
  pack<double, W> result;
  for (int lane = 0; lane < W; ++lane) result.set(lane, f(a[lane], b[lane]));
  return result;
}
}  // namespace detail

template <int W>
pack<double, W> exp(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::exp(x); });
}
template <int W>
pack<double, W> expm1(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::expm1(x); });
}
template <int W>
pack<double, W> log(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::log(x); });
}
template <int W>
pack<double, W> sin(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::sin(x); });
}
template <int W>
pack<double, W> cos(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::cos(x); });
}
template <int W>
pack<double, W> tan(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::tan(x); });
}
template <int W>
pack<double, W> atan(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::atan(x); });
}
template <int W>
pack<double, W> sinh(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::sinh(x); });
}
template <int W>
pack<double, W> cosh(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::cosh(x); });
}
template <int W>
pack<double, W> tanh(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::tanh(x); });
}
/// Inverse sine, lane by lane.
template <int W>
pack<double, W> asin(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::asin(x); });
}
/// Inverse cosine, lane by lane.
template <int W>
pack<double, W> acos(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::acos(x); });
}
/// Cube root, lane by lane.
template <int W>
pack<double, W> cbrt(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::cbrt(x); });
}
/// Error function, lane by lane.
template <int W>
pack<double, W> erf(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::erf(x); });
}
/// Largest whole numbers up to the values, lane by lane.
template <int W>
pack<double, W> floor(const pack<double, W>& a) {
  return detail::by_lane(a, [](double x) { return std::floor(x); });
}
/// Angle of (x, y), lane by lane.
template <int W>
pack<double, W> atan2(const pack<double, W>& a, const pack<double, W>& b) {
  return detail::by_lane(a, b, [](double x, double y) { return std::atan2(x, y); });
}
/// sqrt(x^2 + y^2), without overflow, lane by lane.
template <int W>
pack<double, W> hypot(const pack<double, W>& a, const pack<double, W>& b) {
  return detail::by_lane(a, b, [](double x, double y) { return std::hypot(x, y); });
}
/// Remainder a - b floor(a/b), lane by lane.
template <int W>
pack<double, W> mod(const pack<double, W>& a, const pack<double, W>& b) {
  return detail::by_lane(a, b, [](double x, double y) { return nysalt::mod(x, y); });
}
/// Power of two arguments, lane by lane.
template <int W>
pack<double, W> pow(const pack<double, W>& a, const pack<double, W>& b) {
  return detail::by_lane(a, b, [](double x, double y) { return std::pow(x, y); });
}
/// libm's, lane by lane; the exponent is a constant.
template <int W>
pack<double, W> pow(const pack<double, W>& a, double exponent) {
  return detail::by_lane(a, [&](double x) { return std::pow(x, exponent); });
}

}  // namespace nysalt

namespace Eigen {
/// Lets Eigen store packs in vectors.
template <class T, int W>
struct NumTraits<nysalt::pack<T, W>> : NumTraits<double> {
  using Real = nysalt::pack<T, W>;
  using NonInteger = nysalt::pack<T, W>;
  using Nested = nysalt::pack<T, W>;
  using Literal = double;
  enum { RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
};
/// Lets a user write `f = -2.0 * q`.
template <class T, int W, class Operation>
struct ScalarBinaryOpTraits<double, nysalt::pack<T, W>, Operation> {
  using ReturnType = nysalt::pack<T, W>;
};
template <class T, int W, class Operation>
struct ScalarBinaryOpTraits<nysalt::pack<T, W>, double, Operation> {
  using ReturnType = nysalt::pack<T, W>;
};
}  // namespace Eigen
