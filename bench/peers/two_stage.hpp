// SPDX-License-Identifier: BSL-1.0
// The two-stage step and the Verlet step on the FPU chain of three pairs: ours, and what it is compared with.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "contraction.hpp"
#include "nysalt/scalars/pack.hpp"

namespace nysalt::bench {

using lanes = pack<double>;

template <class T>
struct chain_state {
  std::array<T, 6> q;
  std::array<T, 6> p;
};

/// A(a1) B(b1) A(a2) B(b2) A(a3), the step folded in; k = omega^2/2.
struct two_stage {
  double a1, b1, a2, b2, a3;
  double k;
};

/// Our stepper.
template <contraction>
NYSALT_BENCH_PEER void ours(std::span<chain_state<lanes>>, double omega, std::array<double, 2> theta,
                            double h, std::int64_t steps);

// Boost.Odeint, its own symplectic Nystrom stepper with our coefficients: one do_step a step. Its stages are
// A B pairs, so the last drift brings a third evaluation with it, of coefficient 0.
template <contraction>
NYSALT_BENCH_PEER void odeint_two_stage(std::span<chain_state<double>>, const two_stage&, std::int64_t steps);
template <contraction>
NYSALT_BENCH_PEER void odeint_two_stage(std::span<chain_state<lanes>>, const two_stage&, std::int64_t steps);

// The same two evaluations as ours: the caller of Odeint merges the last drift with the next step's first.
template <contraction>
NYSALT_BENCH_PEER void odeint_merged(std::span<chain_state<double>>, const two_stage&, std::int64_t steps);
template <contraction>
NYSALT_BENCH_PEER void odeint_merged(std::span<chain_state<lanes>>, const two_stage&, std::int64_t steps);

/// Boost.Odeint's velocity_verlet.
template <contraction>
NYSALT_BENCH_PEER void odeint_verlet(chain_state<double>&, double k, double h, std::int64_t steps);
/// Its symplectic Nystrom stepper with Verlet's coefficients, A(1/2) B(1) A(1/2): other states, other bits.
template <contraction>
NYSALT_BENCH_PEER void odeint_verlet_aba(chain_state<double>&, double k, double h, std::int64_t steps);

// By hand, for this chain and this word alone; the second with k c and 4 c as the springs' constants.
template <contraction>
NYSALT_BENCH_PEER void hand_written(std::span<chain_state<lanes>>, const two_stage&, std::int64_t steps);
template <contraction>
NYSALT_BENCH_PEER void hand_folded(std::span<chain_state<lanes>>, const two_stage&, std::int64_t steps);

}  // namespace nysalt::bench
