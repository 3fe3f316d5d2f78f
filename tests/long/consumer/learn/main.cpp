// SPDX-License-Identifier: BSL-1.0
// The least of (theta - 2)^2, by what searches for the learner.
#include "nysalt/learning/minimise.hpp"

#include <cstdio>

int main() {
  using namespace nysalt;
  const objective loss = [](const Eigen::VectorXd& theta) {
    const double r = theta[0] - 2.0;
    return squares{r * r, Eigen::VectorXd::Constant(1, r), Eigen::MatrixXd::Ones(1, 1)};
  };
  const auto anywhere = [](const Eigen::VectorXd&) { return true; };
  const minimum found = minimise(loss, anywhere, Eigen::VectorXd::Zero(1), {0}, 10);
  std::printf("theta = %.4f, %s\n", found.theta[0], found.converged ? "converged" : "not converged");
}

// Expected output:
// theta = 2.0000, converged
