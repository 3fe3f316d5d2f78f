// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstdint>
#include <span>

#include "contraction.hpp"

namespace nysalt::bench {

/// Velocity Verlet on the FPU chain as it stands in textbooks: sites side by side in q and in p, the pull of
/// the last soft bond carried over to the next site, a force array; one pass for the force, one for the rest.
/// k = omega^2/2. f is scratch.
template <contraction>
NYSALT_BENCH_PEER void textbook_chain(std::span<double> q, std::span<double> p, std::span<double> f, double k,
                                      double h, std::int64_t steps);

/// The least that a step must move: q and p are read and written once a step.
template <contraction>
NYSALT_BENCH_PEER void stream(std::span<double> q, std::span<double> p, double c, std::int64_t steps);

}  // namespace nysalt::bench
