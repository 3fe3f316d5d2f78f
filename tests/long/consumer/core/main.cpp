// SPDX-License-Identifier: BSL-1.0
// A pendulum, and a step that cannot be.
#include "nysalt/core.hpp"

#include <cstdio>
#include <exception>

int main() {
  using namespace nysalt;
  const phase_point<double, 1> start{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  const auto end = integrate(pendulum{}, mclachlan2{}, 0.1, start, 1000);
  std::puts(end.diverged_at ? "diverged" : "still swinging");
  try {
    integrate(pendulum{}, mclachlan2{}, 0.0, start, 1000);
  } catch (const std::exception& refusal) {
    std::puts(refusal.what());
  }
}

// Expected output:
// still swinging
// the step must be finite and not zero, got 0
