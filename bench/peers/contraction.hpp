// SPDX-License-Identifier: BSL-1.0
// Peers are compiled twice, without and with the fusing of multiplication and addition, each into a shared
// library of its own that shows nothing but its peers: templates of one build cannot stand in for the
// other's.
#pragma once

#define NYSALT_BENCH_PEER __attribute__((visibility("default")))

namespace nysalt::bench {

enum class NYSALT_BENCH_PEER contraction { off, on };

#ifdef NYSALT_BENCH_CONTRACTION
inline constexpr contraction this_build = contraction::NYSALT_BENCH_CONTRACTION;
#endif

}  // namespace nysalt::bench
