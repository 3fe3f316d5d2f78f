// SPDX-License-Identifier: BSL-1.0
#include "roofs.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "nysalt/scalars/pack.hpp"

namespace nysalt::bench {

namespace {

// As many chains as hide the latency of two units (4 cycles each) or of four (3 cycles), and fit into 16
// registers together with their constants. Odd, so that each chain is multiplied and added to in turn: a
// chain that is only multiplied ends in subnormal numbers, which are slow.
constexpr std::size_t chains = 13;
using part = pack<double>::part;
using registers = std::array<part, chains>;
constexpr std::size_t registers_of_pack = pack<double>::lanes / detail::native_lanes;

/// Multiplications spread evenly among the operations.
constexpr bool multiplies(std::size_t i) {
  constexpr std::size_t all = multiplications + additions;
  return (i + 1) * multiplications / all > i * multiplications / all;
}

template <std::size_t... I>
[[gnu::always_inline]] inline void mix(registers& x, part a, part b, std::index_sequence<I...>) {
  ((x[I % chains] = multiplies(I % (multiplications + additions)) ? x[I % chains] * a : x[I % chains] + b),
   ...);
}

template <std::size_t... I>
[[gnu::always_inline]] inline void fused(registers& x, part a, part b, std::index_sequence<I...>) {
  ((x[I % chains] = x[I % chains] * a + b), ...);
}

double total(const registers& x) {
  double sum = 0.0;
  for (const part& one : x) sum += one[0];
  return sum;
}

// Bounded: a is below 1. The compiler must not know them.
part hidden(double value) {
  volatile double here = value;
  return here - part{};
}
registers different() {
  registers x;
  for (std::size_t i = 0; i < chains; ++i) x[i] = hidden(1.0 + 0.1 * static_cast<double>(i));
  return x;
}

}  // namespace

template <>
double mix_kernel<this_build>(std::int64_t steps) {
  registers x = different();
  const part a = hidden(0.999);
  const part b = hidden(0.001);
  constexpr std::size_t operations = registers_of_pack * (multiplications + additions);
  for (std::int64_t n = 0; n < steps; ++n) mix(x, a, b, std::make_index_sequence<operations>{});
  return total(x);
}

#ifdef NYSALT_BENCH_FUSED
double fma_kernel(std::int64_t steps) {
  registers x = different();
  const part a = hidden(0.999);
  const part b = hidden(0.001);
  constexpr std::size_t operations = registers_of_pack * (multiplications + additions) / 2;
  for (std::int64_t n = 0; n < steps; ++n) fused(x, a, b, std::make_index_sequence<operations>{});
  return total(x);
}
#endif

}  // namespace nysalt::bench
