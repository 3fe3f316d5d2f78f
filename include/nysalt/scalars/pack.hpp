// SPDX-License-Identifier: BSL-1.0
// Several numbers in the registers of the processor that is compiled for: packs and their masks.
#pragma once

#include <immintrin.h>
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "nysalt/scalar.hpp"

#if defined __SSE2__
#endif

namespace nysalt {

namespace detail {

/// Doubles in one register of the target that is compiled for.
#if defined __AVX512F__
inline constexpr int native_lanes = 8;
#elif defined __AVX__
inline constexpr int native_lanes = 4;
#else
inline constexpr int native_lanes = 2;  // SSE2, NEON
#endif

/// The widest register that W lanes fill without a rest.
constexpr int lanes_of_part(int w) {
  int lanes = native_lanes;
  while (w % lanes != 0) lanes /= 2;
  return lanes;
}

/// The compilers' own vectors: + - * / and comparisons are theirs.
template <int N>
struct native_vector {
  typedef double type __attribute__((vector_size(8 * N)));
  typedef std::int64_t mask __attribute__((vector_size(8 * N)));
};
template <>
struct native_vector<1> {
  using type = double;
  using mask = std::int64_t;
};

/// The square root of each lane. The compilers have no word for it, and a loop over std::sqrt would set
/// errno.
inline double native_sqrt(double x) { return std::sqrt(x); }
#if defined __SSE2__
inline native_vector<2>::type native_sqrt(native_vector<2>::type x) { return _mm_sqrt_pd(x); }
#if defined __AVX__
inline native_vector<4>::type native_sqrt(native_vector<4>::type x) { return _mm256_sqrt_pd(x); }
#endif
#if defined __AVX512F__
inline native_vector<8>::type native_sqrt(native_vector<8>::type x) {
  return _mm512_maskz_sqrt_pd(0xff, x);  // g++ 12 warns of the plain one
}
#endif
#else
inline native_vector<2>::type native_sqrt(native_vector<2>::type x) {
  return native_vector<2>::type{std::sqrt(x[0]), std::sqrt(x[1])};
}
#endif

/// Lanes that keep the processor busy: two registers for each number hide each other's latency, and a state
/// of small systems still fits into the first cache.
inline constexpr int default_lanes = 2 * detail::native_lanes;

}  // namespace detail

// A set of lanes of a pack.

namespace detail {

/// Mask of lanes, the result of comparing packs. Not a bool, as lanes may differ.
template <int W>
class lane_mask {
 public:
  static constexpr int lanes = W;                              ///< W, of the packs that were compared
  static constexpr int of_part = detail::lanes_of_part(W);     ///< lanes in a register of the target
  using part = typename detail::native_vector<of_part>::mask;  ///< a register: of a lane all bits, or none

  lane_mask() = default;
  /// All lanes, or none.
  explicit lane_mask(bool all) {
    for (int lane = 0; lane < W; ++lane) set(lane, all);
  }

  /// Whether the mask has lane 0 <= lane < W; not checked.
  bool operator[](int lane) const {
    if constexpr (of_part == 1) {
      return parts[static_cast<std::size_t>(lane)] != 0;
    } else {
      return parts[static_cast<std::size_t>(lane / of_part)][lane % of_part] != 0;
    }
  }
  /// Takes lane 0 <= lane < W in or out; not checked.
  void set(int lane, bool value) {
    if constexpr (of_part == 1) {
      parts[static_cast<std::size_t>(lane)] = value ? -1 : 0;
    } else {
      parts[static_cast<std::size_t>(lane / of_part)][lane % of_part] = value ? -1 : 0;
    }
  }

  /// Lanes that are in both. There is no &&, which would have to leave out its second operand.
  friend lane_mask operator&(const lane_mask& a, const lane_mask& b) {
    lane_mask result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = a.parts[i] & b.parts[i];
    return result;
  }
  /// Lanes that are in a, in b or in both.
  friend lane_mask operator|(const lane_mask& a, const lane_mask& b) {
    lane_mask result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = a.parts[i] | b.parts[i];
    return result;
  }
  /// All other lanes.
  friend lane_mask operator!(const lane_mask& a) {
    lane_mask result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = !a.parts[i];
    return result;
  }

  /// Whether the mask has any lane.
  friend bool any(const lane_mask& which) {
    auto some = which.parts[0];
    for (const auto& part : which.parts) some = some | part;
    if constexpr (of_part == 1) {
      return some != 0;
    } else {
      bool result = false;
      for (int lane = 0; lane < of_part; ++lane) result = result || some[lane] != 0;
      return result;
    }
  }

  /// `if (x < y)` of a system means one branch for all lanes, which there is not.
  template <class T = bool>
  operator bool() const {
    static_assert(!std::same_as<T, bool>,
                  "nysalt: lanes may differ in a comparison, so it cannot choose a branch: write "
                  "nysalt::select(condition, a, b), or let the system say `static constexpr int lanes = 1;`");
    return false;
  }

  std::array<part, W / of_part> parts;  ///< lane k is in parts[k / of_part]
};

}  // namespace detail

// W numbers side by side, one for each of W trajectories, computed with the processor's own vectors.

/// W lanes of T = double. Every operation acts lane by lane and rounds as it does for double, so that lane k
/// of a step over packs has the bits of a step over double. Elementary functions but sqrt are libm's, one
/// lane after the other. A double next to a pack means the same value in all lanes.
template <class T, int W = detail::default_lanes>
  requires(std::same_as<T, double> && 1 <= W && W <= 16)
class pack {
 public:
  static constexpr int lanes = W;                              ///< number of lanes
  static constexpr int of_part = detail::lanes_of_part(W);     ///< lanes in a register of the target
  using part = typename detail::native_vector<of_part>::type;  ///< a register
  using mask = detail::lane_mask<W>;                           ///< result of comparing two packs

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

namespace detail {

/// Whether a type is a pack of any width.
template <class T>
inline constexpr bool is_pack = false;
template <class T, int W>
inline constexpr bool is_pack<pack<T, W>> = true;  ///< a pack is one

}  // namespace detail
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
  return select(a < 0.0, -a, a + 0.0);  // + 0.0 makes 0 of -0
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
