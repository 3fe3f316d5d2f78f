// SPDX-License-Identifier: BSL-1.0
// Two methods on a quartic oscillator.
#include "nysalt/compare.hpp"

#include <cstdio>

#include "nysalt/ensembles/given_states.hpp"

struct quartic {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return 0.25 * q[0] * q[0] * q[0] * q[0];
  }
};

int main() {
  using namespace nysalt;
  const normal_around<1> starts({vector<double, 1>(1.0), vector<double, 1>(0.0)}, 0.1, 0.1);
  const comparison_options asked{
      .methods = {"verlet", "pefrl"}, .steps = {0.05}, .equal_cost = true, .trajectories = 16};
  const auto rows = compare({.system = quartic{}, .starts = starts}, asked).rows();
  std::printf("%s\n", rows[1].value.mean < rows[0].value.mean ? "pefrl errs less" : "verlet errs less");
}

// Expected output:
// pefrl errs less
