// SPDX-License-Identifier: BSL-1.0
// What is the best two-stage method for q'' = -omega^2 q at the step h, and how far does it stay stable?
//
// On a linear system both questions have closed answers. The one-step error is |e^{A h} - B|^2 with the
// method's matrix B, a function of b1, beta1 and z = h omega only if it is measured in the energy norm.
// Learning sees only data, two pairs of states, and must find the same minimum. And the method is stable
// as long as |trace B| <= 2, which a long run must confirm on both sides of the limit.
#include <fmt/format.h>

#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

/// |e^{A h} - B|^2 in the energy norm for b1 = 1/2 and s = c2 - c1 = 4 beta1 - 1, from the matrix of
/// A((1-s)/2) B(1/2) A(s) B(1/2) A((1-s)/2) in (omega q, p).
double closed_form_error(double beta1, double z) {
  const double s = 4.0 * beta1 - 1.0;
  const double c = 0.5 * (1.0 - s);
  const double half_trace = 1.0 - z * z / 2.0 + z * z * z * z * s * (1.0 - s) / 8.0;
  const double pq = -z + z * z * z * s / 4.0;
  const double qp =
      z * (1.0 - z * z * (c * (1.0 - c) + (1.0 - c) * c) / 2.0) + z * z * z * z * z * c * c * s / 4.0;
  return 2.0 * std::pow(std::cos(z) - half_trace, 2) + std::pow(std::sin(z) - qp, 2) +
         std::pow(-std::sin(z) - pq, 2);
}

int main() {
  constexpr double omega = 3.0;
  const harmonic_oscillator system(omega);
  const listed<1> two_states({{vector<double, 1>(1.0 / omega), vector<double, 1>(0.0)},
                              {vector<double, 1>(0.0), vector<double, 1>(1.0)}});
  fmt::print("   z    learned b1   learned beta1   closed form\n");
  for (const double z : {0.5, 1.0, 2.0}) {
    const double step = z / omega;
    const auto data = make_flow_map_data(system, two_states, exact_linear(system),
                                         {.step = step, .horizon = step, .trajectories = 2});
    const auto [theta, summary, method] =
        learn(nystrom{}, system, data, data, {.coordinates = coordinates::energy});
    const auto closed = boost::math::tools::brent_find_minima(
        [&](double x) { return closed_form_error(x, z); }, 0.35, 0.45, 50);
    fmt::print("{:4.1f} {:12.6f} {:15.7f} {:13.7f}\n", z, theta[0], theta[1], closed.first);
  }

  fmt::print("\nStable for z in");
  const auto method = member(nystrom{}, {0.5, 0.4});
  for (const auto& [low, high] : stability_windows(method)) fmt::print(" [{:.6f}, {:.6f}]", low, high);
  fmt::print("; sqrt(20/3) = {:.6f}\n", std::sqrt(20.0 / 3.0));
  const phase_point<double, 1> start{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  for (const double factor : {0.999, 1.001}) {
    const double step = factor * stability_limit(method) / omega;
    const auto end = integrate(system, method, step, start, 1'000'000);
    fmt::print("{:.3f} of the limit: {}\n", factor,
               end.diverged_at ? fmt::format("diverged at step {}", *end.diverged_at)
                               : fmt::format("bounded over {} steps", end.steps));
  }
}

// Expected output:
//    z    learned b1   learned beta1   closed form
//  0.5     0.500000       0.4027265     0.4027265
//  1.0     0.500000       0.4005818     0.4005818
//  2.0     0.500000       0.3901642     0.3901642
//
// Stable for z in [0.000000, 2.581989] [3.162278, 4.082483]; sqrt(20/3) = 2.581989
// 0.999 of the limit: bounded over 1000000 steps
// 1.001 of the limit: diverged at step 88
