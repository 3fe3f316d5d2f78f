// SPDX-License-Identifier: BSL-1.0
// The kernels that one would write for this chain and this word alone: the state in locals, all unrolled.
#include "two_stage.hpp"

namespace nysalt::bench {

namespace {

/// p += c force(q), the 4 of quartic springs multiplied into c: fused, all p take one operation each.
[[gnu::always_inline]] inline void kick(const std::array<lanes, 6>& q, std::array<lanes, 6>& p, double four_c,
                                        double quarter_k) {
  const auto cube = [](const lanes& u) __attribute__((always_inline)) { return u * u * u; };
  const lanes soft_0 = cube(q[0]);
  const lanes stiff_0 = (q[1] - q[0]) * quarter_k;
  const lanes soft_1 = cube(q[2] - q[1]);
  p[0] += (stiff_0 - soft_0) * four_c;
  p[1] += (soft_1 - stiff_0) * four_c;
  const lanes stiff_1 = (q[3] - q[2]) * quarter_k;
  const lanes soft_2 = cube(q[4] - q[3]);
  p[2] += (stiff_1 - soft_1) * four_c;
  p[3] += (soft_2 - stiff_1) * four_c;
  const lanes stiff_2 = (q[5] - q[4]) * quarter_k;
  const lanes soft_3 = cube(q[5]);
  p[4] += (stiff_2 - soft_2) * four_c;
  p[5] -= (soft_3 + stiff_2) * four_c;
}

/// The same with all constants in the springs, and no force in between: the least operations.
[[gnu::always_inline]] inline void folded_kick(const std::array<lanes, 6>& q, std::array<lanes, 6>& p,
                                               double four_c, double k_c) {
  const auto quartic = [&](const lanes& u) __attribute__((always_inline)) { return u * u * (u * four_c); };
  const lanes soft_0 = quartic(q[0]);
  const lanes stiff_0 = (q[1] - q[0]) * k_c;
  const lanes soft_1 = quartic(q[2] - q[1]);
  p[0] += stiff_0 - soft_0;
  p[1] += soft_1 - stiff_0;
  const lanes stiff_1 = (q[3] - q[2]) * k_c;
  const lanes soft_2 = quartic(q[4] - q[3]);
  p[2] += stiff_1 - soft_1;
  p[3] += soft_2 - stiff_1;
  const lanes stiff_2 = (q[5] - q[4]) * k_c;
  const lanes soft_3 = quartic(q[5]);
  p[4] += stiff_2 - soft_2;
  p[5] -= soft_3 + stiff_2;
}

[[gnu::always_inline]] inline void drift(std::array<lanes, 6>& q, const std::array<lanes, 6>& p, double c) {
  for (std::size_t i = 0; i < 6; ++i) q[i] += p[i] * c;
}

[[gnu::always_inline]] inline void run(std::span<chain_state<lanes>> states, const two_stage& c,
                                       std::int64_t steps, auto first_kick, auto second_kick) {
  const double seam = c.a3 + c.a1;
  const double a2 = c.a2;
  for (auto& x : states) {
    auto q = x.q;
    auto p = x.p;
    drift(q, p, c.a1);
    for (std::int64_t n = 0; n < steps; ++n) {
      first_kick(q, p);
      drift(q, p, a2);
      second_kick(q, p);
      drift(q, p, seam);
    }
    drift(q, p, -c.a1);
    x = {q, p};
  }
}

}  // namespace

template <>
void hand_written<this_build>(std::span<chain_state<lanes>> states, const two_stage& c, std::int64_t steps) {
  const auto with = [&](double b) {
    return [ four = 4.0 * b, k = 0.25 * c.k ](const auto& q, auto& p) __attribute__((always_inline)) {
      kick(q, p, four, k);
    };
  };
  run(states, c, steps, with(c.b1), with(c.b2));
}

template <>
void hand_folded<this_build>(std::span<chain_state<lanes>> states, const two_stage& c, std::int64_t steps) {
  const auto with = [&](double b) {
    return [ four = 4.0 * b, k = c.k * b ](const auto& q, auto& p) __attribute__((always_inline)) {
      folded_kick(q, p, four, k);
    };
  };
  run(states, c, steps, with(c.b1), with(c.b2));
}

}  // namespace nysalt::bench
