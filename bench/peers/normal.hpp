// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstdint>
#include <span>

#include "contraction.hpp"

namespace nysalt::bench {

// Fills with standard normal numbers, one after the other from one engine. Each distribution once with
// mt19937_64, and once with splitmix64, about the fastest engine of 64 bits that there is.
template <contraction>
NYSALT_BENCH_PEER void std_normal(std::span<double>);
template <contraction>
NYSALT_BENCH_PEER void std_normal_splitmix(std::span<double>);
template <contraction>
NYSALT_BENCH_PEER void boost_ziggurat(std::span<double>);
template <contraction>
NYSALT_BENCH_PEER void boost_ziggurat_splitmix(std::span<double>);

}  // namespace nysalt::bench
