// SPDX-License-Identifier: BSL-1.0
// A pendulum in a project that holds the sources of nysalt.
#include <cstdio>

#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/pendulum.hpp"

int main() {
  using namespace nysalt;
  const phase_point<double, 1> start{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  const auto end = integrate(pendulum{}, mclachlan2{}, 0.1, start, 1000);
  std::puts(end.diverged_at ? "diverged" : "still swinging");
}

// Expected output:
// still swinging
