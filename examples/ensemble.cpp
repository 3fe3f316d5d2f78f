// SPDX-License-Identifier: BSL-1.0
// Many trajectories at once: how energy leaves the first stiff spring of a chain, on average.
//
// All of it is in the first spring at the start, and the soft springs hand it on slowly, each trajectory in
// its own way. A thousand of them go through the processor's vectors side by side and on all its cores; the
// numbers would be the same, to the bit, one after the other.
#include <fmt/format.h>

#include <thread>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

int main() {
  constexpr double step = 0.02;
  constexpr std::int64_t trajectories = 1000;
  constexpr std::int64_t every = 5000;
  const fpu_chain<3> chain(50.0);
  // One stretched spring, and otherwise small random motion around rest.
  phase_point<double, 6> one_spring{vector<double, 6>::Zero(), vector<double, 6>::Zero()};
  one_spring.p << -1.0, 1.0, 0.0, 0.0, 0.0, 0.0;
  const normal_around<6> law(one_spring, 0.005, 0.1);

  // energies[k][m]: of the first spring at t = k * every * step, along trajectory m.
  std::vector<std::vector<double>> energies(6, std::vector<double>(trajectories));
  const auto of_first_spring = over_lanes([&](const auto& x) { return chain.stiff_energy(x, 0); });
  const auto take = [&](std::int64_t m, std::int64_t n, double energy) {
    energies[static_cast<std::size_t>(n / every)][static_cast<std::size_t>(m)] = energy;
  };
  const ensemble_options options{
      .trajectories = trajectories,
      .steps = 5 * every,
      .every = every,
      .execution = {.threads = static_cast<int>(std::thread::hardware_concurrency())}};
  const auto diverged_at = integrate_ensemble(chain, srkn6b(), step, law, options, of_first_spring, take);

  for (std::size_t k = 0; k < energies.size(); ++k) {
    const auto [mean, error] = mean_and_error(energies[k]);
    fmt::print("t = {:3.0f}  I_1 = {:.3f} +- {:.3f}\n", static_cast<double>(k) * every * step, mean, error);
  }
  std::size_t diverged = 0;
  for (const auto& at : diverged_at) diverged += at ? 1 : 0;
  fmt::print("{} of {} diverged\n", diverged, trajectories);
}

// Expected output:
// t =   0  I_1 = 1.039 +- 0.005
// t = 100  I_1 = 1.013 +- 0.005
// t = 200  I_1 = 0.940 +- 0.006
// t = 300  I_1 = 0.837 +- 0.008
// t = 400  I_1 = 0.726 +- 0.009
// t = 500  I_1 = 0.621 +- 0.010
// 0 of 1000 diverged
