// SPDX-License-Identifier: BSL-1.0
// Ours, compiled as the peers are: fused is what NYSALT_FP_CONTRACT gives.
#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"
#include "nysalt/method.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "two_stage.hpp"

namespace nysalt::bench {

namespace {

/// Each block opened, advanced and closed.
template <class Stepper>
void advance(const Stepper& stepper, std::span<chain_state<lanes>> states, std::int64_t steps) {
  for (auto& state : states) {
    phase_point<lanes, 6> x;
    for (std::size_t i = 0; i < 6; ++i) {
      x.q[static_cast<Eigen::Index>(i)] = state.q[i];
      x.p[static_cast<Eigen::Index>(i)] = state.p[i];
    }
    auto run = stepper.open(x);
    stepper.advance(run, steps);
    x = stepper.synchronous(run);
    for (std::size_t i = 0; i < 6; ++i) {
      state.q[i] = x.q[static_cast<Eigen::Index>(i)];
      state.p[i] = x.p[static_cast<Eigen::Index>(i)];
    }
  }
}

}  // namespace

template <>
void ours<this_build>(std::span<chain_state<lanes>> states, double omega, std::array<double, 2> theta,
                      double h, std::int64_t steps) {
  const fpu_chain<3> chain(omega);
  advance(make_stepper(chain, member(nystrom(), {theta[0], theta[1]}), h), states, steps);
}

}  // namespace nysalt::bench
