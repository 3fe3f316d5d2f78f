// SPDX-License-Identifier: BSL-1.0
#include "scalar_baoab.hpp"

#include <array>
#include <boost/random/normal_distribution.hpp>
#include <random>

#include "splitmix.hpp"

namespace nysalt::bench {

namespace {

using numbers = std::array<double, 6>;

/// p += c force(q), no force array in between.
void kick(const numbers& q, numbers& p, double k, double c) {
  const auto quartic = [](double u) { return 4.0 * u * u * u; };
  double left = quartic(q[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const double stiff = k * (q[2 * i + 1] - q[2 * i]);
    const double right = quartic(i < 2 ? q[2 * i + 2] - q[2 * i + 1] : -q[2 * i + 1]);
    p[2 * i] += c * (stiff - left);
    p[2 * i + 1] += c * (right - stiff);
    left = right;
  }
}

void drift(numbers& q, const numbers& p, double c) {
  for (std::size_t i = 0; i < 6; ++i) q[i] += c * p[i];
}

/// Adjacent kicks drawn together, as ours are.
template <class Distribution, class Engine>
void baoab(std::span<chain_state<double>> states, const langevin_run& run, std::int64_t steps) {
  Engine engine;
  Distribution normal;
  const double half = 0.5 * run.h;
  for (auto& state : states) {
    auto [q, p] = state;
    kick(q, p, run.k, half);
    for (std::int64_t n = 1; n <= steps; ++n) {
      drift(q, p, half);
      for (double& one : p) one = run.decay * one + run.deviation * normal(engine);
      drift(q, p, half);
      kick(q, p, run.k, n < steps ? run.h : half);
    }
    state = {q, p};
  }
}

}  // namespace

template <>
void baoab_ziggurat<this_build>(std::span<chain_state<double>> x, const langevin_run& run,
                                std::int64_t steps) {
  baoab<boost::random::normal_distribution<double>, std::mt19937_64>(x, run, steps);
}
template <>
void baoab_ziggurat_splitmix<this_build>(std::span<chain_state<double>> x, const langevin_run& run,
                                         std::int64_t steps) {
  baoab<boost::random::normal_distribution<double>, splitmix>(x, run, steps);
}
template <>
void baoab_std<this_build>(std::span<chain_state<double>> x, const langevin_run& run, std::int64_t steps) {
  baoab<std::normal_distribution<double>, std::mt19937_64>(x, run, steps);
}
template <>
void baoab_std_splitmix<this_build>(std::span<chain_state<double>> x, const langevin_run& run,
                                    std::int64_t steps) {
  baoab<std::normal_distribution<double>, splitmix>(x, run, steps);
}

}  // namespace nysalt::bench
