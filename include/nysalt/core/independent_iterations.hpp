// SPDX-License-Identifier: BSL-1.0
// Loops whose iterations do not depend on each other, and what compilers want to know of them.
#pragma once

#include <Eigen/Core>
#include <type_traits>

namespace nysalt::detail {

/// body(n) for n = begin .. end - 1, where what an iteration writes no other reads: compilers vectorise
/// without comparing addresses first. T is the type of the numbers: clang++ is asked to vectorise over
/// doubles only, as it warns, in the user's build, of a loop that stays scalar, such as one over packs or
/// dual numbers.
template <class T>
[[gnu::always_inline]] inline void for_independent(Eigen::Index begin, Eigen::Index end, const auto& body) {
#if defined __clang__
// A loop with the instructions of a sanitizer or of coverage stays scalar; with -g1 or more clang++ places
// the warning here, without debug information at the caller.
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wpass-failed"
  if constexpr (std::is_floating_point_v<T>) {
#pragma clang loop vectorize(assume_safety)
    for (Eigen::Index n = begin; n < end; ++n) body(n);
  } else {
    for (Eigen::Index n = begin; n < end; ++n) body(n);
  }
#pragma clang diagnostic pop
#else
#if defined __GNUC__
#pragma GCC ivdep
#endif
  for (Eigen::Index n = begin; n < end; ++n) body(n);
#endif
}

/// The array x, which compilers take for another one. Of x[n] and x[n + 1] in one loop clang++ carries the
/// second over to the next n in a register, and then does not vectorise.
template <class T>
[[gnu::always_inline]] inline const T* as_another_array(const T* x) {
  asm("" : "+r"(x));
  return x;
}

}  // namespace nysalt::detail
