// SPDX-License-Identifier: BSL-1.0
// The registers of the processor that is compiled for.
#pragma once

#if defined __SSE2__
#include <immintrin.h>
#endif

#include <cmath>
#include <cstdint>

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

}  // namespace detail

/// Lanes that keep the processor busy: two registers for each number hide each other's latency, and a state
/// of small systems still fits into the first cache.
inline constexpr int default_lanes = 2 * detail::native_lanes;

}  // namespace nysalt
