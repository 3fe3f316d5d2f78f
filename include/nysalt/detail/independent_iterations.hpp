// SPDX-License-Identifier: BSL-1.0
// Loops whose iterations do not depend on each other, and what compilers want to know of them.
#pragma once

/// Before a loop: what an iteration writes no other reads, so that compilers vectorise without comparing
/// addresses first. NYSALT_END_OF_ITERATIONS follows the loop: clang++ would warn, in the user's build, of a
/// loop that stays scalar, as under sanitizers.
#if defined __clang__
#define NYSALT_INDEPENDENT_ITERATIONS                                                    \
  _Pragma("clang diagnostic push") _Pragma("clang diagnostic ignored \"-Wpass-failed\"") \
      _Pragma("clang loop vectorize(assume_safety)")
#define NYSALT_END_OF_ITERATIONS _Pragma("clang diagnostic pop")
#else
#define NYSALT_END_OF_ITERATIONS
#if defined __GNUC__
#define NYSALT_INDEPENDENT_ITERATIONS _Pragma("GCC ivdep")
#else
#define NYSALT_INDEPENDENT_ITERATIONS
#endif
#endif

namespace nysalt::detail {

/// The array x, which compilers take for another one. Of x[n] and x[n + 1] in one loop clang++ carries the
/// second over to the next n in a register, and then does not vectorise.
template <class T>
[[gnu::always_inline]] inline const T* as_another_array(const T* x) {
  asm("" : "+r"(x));
  return x;
}

}  // namespace nysalt::detail
