// SPDX-License-Identifier: BSL-1.0
// What the processor can do at most: arithmetic in registers, without memory and without waiting.
#pragma once

#include <cstdint>
#include <span>

#include "contraction.hpp"

namespace nysalt::bench {

/// Operations of one two-stage step on the FPU chain of three pairs: a kick takes 2 multiplications for each
/// of 4 quartic springs, 1 for each of 3 stiff ones and 6 for the momenta, with 5 + 6 + 6 additions; a drift
/// 6 and 6; and a step is two of each. They are counted before the race.
inline constexpr int multiplications = 2 * (4 * 2 + 3 + 6 + 6);
inline constexpr int additions = 2 * (5 + 6 + 6 + 6);

/// As many multiplications and additions as `steps` steps of pack<double>::lanes trajectories, as fast as
/// they go. Returns a number that depends on all of them.
template <contraction>
NYSALT_BENCH_PEER double mix_kernel(std::int64_t steps);

/// As many operations again, all of them in fused multiply-adds: the peak that processors are sold with. With
/// contraction off there is none.
NYSALT_BENCH_PEER double fma_kernel(std::int64_t steps);

}  // namespace nysalt::bench
