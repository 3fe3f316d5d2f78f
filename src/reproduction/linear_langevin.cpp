// SPDX-License-Identifier: BSL-1.0
// The paper's analysis of the damped oscillator (section 4.2). See docs/theory-langevin-optimum.md.
#include <Eigen/Dense>

#include "linear_steps.hpp"
#include "parts.hpp"

namespace nysalt::program::paper {

namespace {

/// ||O B - exp(A h)||^2 in the energy norm, with O = diag(1, e^{-gamma h}) behind the step, or one half of it
/// before and one behind. omega is 1: h is z and gamma is gamma/omega.
double loss(const two_parameters& at, double z, double gamma, bool symmetric) {
  const auto damping = [&](double part) {
    return Eigen::Matrix2d(Eigen::Vector2d(1.0, std::exp(-gamma * z * part)).asDiagonal());
  };
  const Eigen::Matrix2d step = one_step(at, z, 1.0);
  const Eigen::Matrix2d damped =
      symmetric ? Eigen::Matrix2d(damping(0.5) * step * damping(0.5)) : Eigen::Matrix2d(damping(1.0) * step);
  return (damped - exact_step(z, 1.0, gamma)).squaredNorm();
}

/// d beta1*/d(gamma/(Omega delta)) at b1 = 1/2 and gamma -> 0, which is printed as -0.43.
double slope_of_optimum(double z, bool symmetric) {
  const auto beta1 = [&](double gamma) {
    const auto along = [&](const two_parameters& at) {  // b1 is kept
      const double off = at[0] - 0.5;
      return loss({0.5, at[1]}, z, gamma, symmetric) + std::pow(z, 6) * off * off;
    };
    return minimum_near({0.5, 0.4}, along)[1];
  };
  const double g = 3e-4 * z;
  return (4.0 * beta1(g) - beta1(2.0 * g) - 3.0 * beta1(0.0)) / (2.0 * g) * z;
}

}  // namespace

exhibit linear_langevin_optimum(const setting&) {
  table all({"delta omega", "O at the end, as in the paper", "O symmetric"}, 0);
  for (const double z : {0.2, 0.5, 1.0, 2.0}) {
    all.add({fmt::format("{:g}", z), fmt::format("{:.4f}", slope_of_optimum(z, false)),
             fmt::format("{:.4f}", slope_of_optimum(z, true))});
  }
  const auto is_printed = [](double slope) { return agrees({slope, 0.0}, -0.43, 0.01); };
  const std::vector<reading> readings{
      {"small steps (delta omega = 0.2)", is_printed(slope_of_optimum(0.2, false))},
      {"delta omega = 1", is_printed(slope_of_optimum(1.0, false))},
      {"delta omega = 2", is_printed(slope_of_optimum(2.0, false))}};
  return {
      "Optimal parameters of the linear Langevin system",
      "Remark on optimal parameters, section 4.2",
      {{"beta1* about 0.40 - 0.43 gamma/(Omega delta)",
        "d beta1*/d(gamma/(Omega delta)) at b1 = 1/2, gamma -> 0, energy norm",
        fmt::format("{:.4f}, {:.4f} and {:.4f} at delta omega = 0.2, 1 and 2", slope_of_optimum(0.2, false),
                    slope_of_optimum(1.0, false), slope_of_optimum(2.0, false)),
        verdict_of("the step: the remark expands in it", readings),
        summary_of(readings) + "; to the printed digits", ""}},
      {"The slope is of the placement, not of the system: with half of the bath before the step and half "
       "behind there is none. In the setting of section 5.3 the shift is below 0.0005."},
      {{"The slope:", all}},
      {}};
}

namespace {

/// Root mean square of what the exact noise of a step from a known state, sigma int e^{A s} (0, dW), has
/// beyond the scheme's (0, sigma int e^{-gamma s} dW) on the same path, for sigma = 1; by Simpson's rule.
double one_step_noise(double h, double gamma, double Omega, bool of_q) {
  constexpr int pieces = 200;
  double sum = 0.0;
  for (int i = 0; i <= pieces; ++i) {
    const double s = h * i / pieces;
    const Eigen::Matrix2d exact = exact_step(s, Omega, gamma);
    const double off = of_q ? exact(0, 1) : exact(1, 1) - std::exp(-gamma * s);
    const double weight = i == 0 || i == pieces ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += weight * off * off;
  }
  return std::sqrt(sum * h / pieces / 3.0);
}

/// The whole one-step error from a state of covariance diag(1, 1) kT with kT = sigma^2/(2 gamma), sigma = 1.
double one_step_error(double h, double gamma) {
  const Eigen::Matrix2d damping = Eigen::Vector2d(1.0, std::exp(-gamma * h)).asDiagonal();
  const Eigen::Matrix2d E = damping * one_step({0.5, 0.4}, h, 1.0) - exact_step(h, 1.0, gamma);
  const double of_states = E.norm() * std::sqrt(1.0 / (2.0 * gamma));
  return std::hypot(of_states,
                    std::hypot(one_step_noise(h, gamma, 1.0, true), one_step_noise(h, gamma, 1.0, false)));
}

}  // namespace

exhibit linear_langevin_order(const setting&) {
  std::vector<double> steps;
  std::vector<double> errors;
  std::vector<double> of_q;
  std::vector<double> of_p;
  for (double h = 0.02; h > 1e-3; h *= 0.5) {
    steps.push_back(h);
    errors.push_back(one_step_error(h, 0.5));
    of_q.push_back(one_step_noise(h, 0.5, 1.0, true));
    of_p.push_back(one_step_noise(h, 0.5, 1.0, false));
  }
  const estimate order = exponent(steps, errors);
  return {"Local strong order of the linear Langevin scheme",
          "Remark on the order, section 4.2",
          {{"the local strong order is 1.5",
            "exponent of the root mean square error of one step, Omega = 1, gamma = 0.5",
            fmt::format("{:.3f} (noise of q only {:.3f}, of p only {:.3f})", order.mean,
                        exponent(steps, of_q).mean, exponent(steps, of_p).mean),
            verdict_of(agrees(order, 1.5, 0.1)),
            "to the printed digits; the covariance of the noise is integrated, no sampling", ""}},
          {"Globally this is the strong order 1: errors of independent steps add up as a root."}};
}

}  // namespace nysalt::program::paper
