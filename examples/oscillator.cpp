// SPDX-License-Identifier: BSL-1.0
// The first fifteen lines: an oscillator, Verlet's method, and an energy that swings and does not drift.
#include <fmt/format.h>

#include "nysalt/nysalt.hpp"

int main() {
  // [oscillator]
  using namespace nysalt;
  const harmonic_oscillator spring(1.0);  // H = p^2/2 + q^2/2
  const phase_point<double, 1> start{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  const auto watch = [&](std::int64_t, double t, const auto& x) {
    fmt::print("t = {:6.0f}  q = {:+.4f}  H = {:.4f}\n", t, x.q[0], energy<double>(spring, x));
  };
  integrate(spring, verlet{}, 0.5, start, 20'000, watch, 4'000);  // 20,000 steps of 0.5, seen every 4,000
  // [/oscillator]
}

// Expected output:
// t =      0  q = +1.0000  H = 0.5000
// t =   2000  q = -0.1720  H = 0.4697
// t =   4000  q = -0.9409  H = 0.4964
// t =   6000  q = +0.4956  H = 0.4764
// t =   8000  q = +0.7704  H = 0.4873
// t =  10000  q = -0.7605  H = 0.4868
