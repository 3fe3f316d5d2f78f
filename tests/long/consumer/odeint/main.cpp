// SPDX-License-Identifier: BSL-1.0
// Verlet as a stepper of Boost.Odeint: a pendulum at its turning point.
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <cstdio>

#include "nysalt/methods/classical.hpp"
#include "nysalt/references/odeint.hpp"
#include "nysalt/systems/textbook.hpp"

int main() {
  using namespace nysalt;
  phase_point<double, 1> x{vector<double, 1>(0.1), vector<double, 1>(0.0)};
  // Half a period of small swings, pi, and one part in 1600 more at this amplitude.
  boost::numeric::odeint::integrate_n_steps(odeint_stepper(verlet()), pendulum{}, x, 0.0, 0.0314356, 100);
  std::printf("%.3f\n", x.q[0]);
}

// Expected output:
// -0.100
