// SPDX-License-Identifier: BSL-1.0
// BAOAB on the FPU chain of three pairs in a bath, as one writes it: a trajectory after the other.
#pragma once

#include <cstdint>
#include <span>

#include "contraction.hpp"
#include "two_stage.hpp"

namespace nysalt::bench {

/// The chain of stiffness k = omega^2/2, the step, and what O does in it: p <- decay p + deviation xi.
struct langevin_run {
  double k;
  double h;
  double decay;
  double deviation;
};

// One generator for all of the run, of Boost (a ziggurat) or of the standard library. Each once with
// mt19937_64 and once with splitmix64.
template <contraction>
NYSALT_BENCH_PEER void baoab_ziggurat(std::span<chain_state<double>>, const langevin_run&,
                                      std::int64_t steps);
template <contraction>
NYSALT_BENCH_PEER void baoab_ziggurat_splitmix(std::span<chain_state<double>>, const langevin_run&,
                                               std::int64_t steps);
template <contraction>
NYSALT_BENCH_PEER void baoab_std(std::span<chain_state<double>>, const langevin_run&, std::int64_t steps);
template <contraction>
NYSALT_BENCH_PEER void baoab_std_splitmix(std::span<chain_state<double>>, const langevin_run&,
                                          std::int64_t steps);

}  // namespace nysalt::bench
