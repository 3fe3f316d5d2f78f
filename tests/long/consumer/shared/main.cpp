// SPDX-License-Identifier: BSL-1.0
// The library calls a system of ours, and throws what we catch.
#include <cstdio>
#include <stdexcept>

#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

struct quartic {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0] * q[0] * q[0];
  }
};

int main() {
  const nysalt::model system = quartic{};
  std::printf("K'' = %.1f\n", system.kinetic_hessian(Eigen::VectorXd::Zero(1))(0, 0));
  try {
    nysalt::histogram({.low = 1.0, .high = 0.0, .count = 10});
  } catch (const std::invalid_argument& refusal) {
    std::puts("refused");
  }
}

// Expected output:
// K'' = 1.0
// refused
