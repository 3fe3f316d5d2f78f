// SPDX-License-Identifier: BSL-1.0
// Eight oscillators on two threads.
#include <algorithm>
#include <array>
#include <cstdio>

#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"
#include "nysalt/systems/textbook.hpp"

int main() {
  using namespace nysalt;
  const harmonic_oscillator system(1.0);
  std::array<bool, 8> bounded{};
  for_each_trajectory(8, {.threads = 2}, [&](std::int64_t m) {
    const phase_point<double, 1> start{vector<double, 1>(1.0 + static_cast<double>(m)),
                                       vector<double, 1>(0.0)};
    bounded[static_cast<std::size_t>(m)] = !integrate(system, verlet{}, 0.1, start, 1000).diverged_at;
  });
  std::printf("%d of 8 are bounded\n", static_cast<int>(std::count(bounded.begin(), bounded.end(), true)));
}

// Expected output:
// 8 of 8 are bounded
