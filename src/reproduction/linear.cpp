// SPDX-License-Identifier: BSL-1.0
// The paper's analysis of the harmonic oscillator q'' = -Omega q (section 4.1): optimum and stability.
#include <Eigen/Dense>

#include <array>
#include <functional>
#include <numbers>

#include "comparison/catalogue.hpp"
#include "comparison/stability.hpp"
#include "linear_steps.hpp"
#include "parts.hpp"

namespace nysalt::program::paper {

namespace {

using matrix = Eigen::Matrix2d;

/// ||E||^2 of E = B - exp(A h), in x = omega q and y = p: every entry counts as energy.
double energy_loss(const two_parameters& at, double z) {
  return (one_step(at, z, 1.0) - exact_step(z, 1.0, 0.0)).squaredNorm();
}

/// Tr(E^T Sigma^-1 E) with Sigma = diag(1, Omega^2), as printed.
double printed_loss(const two_parameters& at, double z, double frequency) {
  const double Omega = frequency * frequency;
  const matrix E = one_step(at, z / frequency, Omega) - exact_step(z / frequency, Omega, 0.0);
  return E.row(0).squaredNorm() + E.row(1).squaredNorm() / (Omega * Omega);
}

two_parameters energy_optimum(double z) {
  return minimum_near({0.5, 0.4}, [z](const two_parameters& at) { return energy_loss(at, z); });
}
two_parameters printed_optimum(double z, double frequency) {
  return minimum_near({0.5, 0.4}, [=](const two_parameters& at) { return printed_loss(at, z, frequency); });
}

const std::vector<double> angles{0.1, 0.5, 1.0, 1.5, 2.0};

bool is_printed_optimum(const two_parameters& found) {  // "b1 = 0.5 and beta1 about 0.40"
  return agrees({found[0], 0.0}, 0.5, 0.1) && agrees({found[1], 0.0}, 0.40, 0.01);
}

tested_claim value_of_optimum() {
  const auto by_energy = energy_optimum(1.0);
  const auto as_printed = printed_optimum(1.0, omega);
  const std::vector<reading> readings{
      {"the energy norm", is_printed_optimum(by_energy)},
      {"Sigma = diag(1, Omega^2) as printed", is_printed_optimum(as_printed)}};
  return {"b1* = 0.5, beta1* about 0.40",
          "the minimum at delta omega = 1 (omega = 50 for the printed Sigma)",
          fmt::format("energy norm {:.5f}, {:.5f}; printed Sigma {:.5f}, {:.5f}", by_energy[0], by_energy[1],
                      as_printed[0], as_printed[1]),
          verdict_of("the weights of the loss", readings),
          summary_of(readings) + "; to the printed digits",
          "nysalt learn --system oscillator --loss state:1 --omega 50 --step 0.02 --coordinates energy"};
}

tested_claim independence_of_omega() {
  double by_energy = 0.0;
  double as_printed = 0.0;
  for (const double other : {1.0, 10.0, 50.0}) {
    as_printed =
        std::max(as_printed, std::abs(printed_optimum(1.0, other)[1] - printed_optimum(1.0, 1.0)[1]));
    const auto in_units = [&](const two_parameters& at) {  // the same norm, written in q and p
      matrix E = one_step(at, 1.0 / other, other * other) - exact_step(1.0 / other, other * other, 0.0);
      E(0, 1) *= other;
      E(1, 0) /= other;
      return E.squaredNorm();
    };
    by_energy = std::max(by_energy, std::abs(minimum_near({0.5, 0.4}, in_units)[1] - energy_optimum(1.0)[1]));
  }
  const std::vector<reading> readings{{"the energy norm", by_energy <= 5e-3},
                                      {"Sigma as printed", as_printed <= 5e-3}};
  return {"the estimator is independent of Omega, because of the weight matrix Sigma",
          "largest change of beta1* from omega = 1 to 50 at delta omega = 1",
          fmt::format("energy norm {:.1e}; printed Sigma {:.4f}", by_energy, as_printed),
          verdict_of("the weights of the loss", readings),
          summary_of(readings) +
              "; a change of half the last printed digit (.005) is none. diag(1, Omega^2) adds "
              "squares of different units",
          ""};
}

tested_claim independence_of_delta() {
  const auto change_up_to = [](double most) {
    double worst = 0.0;
    for (const double z : angles) {
      if (z <= most) worst = std::max(worst, std::abs(energy_optimum(z)[1] - energy_optimum(0.1)[1]));
    }
    return worst;
  };
  const std::vector<reading> readings{{"delta omega up to 1", change_up_to(1.0) <= 5e-3},
                                      {"delta omega up to 2", change_up_to(2.0) <= 5e-3}};
  return {"the minimisers appear to be independent of delta",
          "largest change of beta1* (energy norm) from delta omega = 0.1 on",
          fmt::format("{:.4f} up to 1, {:.4f} up to 2", change_up_to(1.0), change_up_to(2.0)),
          verdict_of("how large the step is", readings),
          summary_of(readings) + "; a change of half the last printed digit (.005) is none",
          "nysalt learn --system oscillator --loss state:1 --omega 50 --steps 0.01,0.02,0.03,0.04 "
          "--coordinates energy"};
}

}  // namespace

exhibit linear_optimum(const setting&) {
  const auto both = [](const two_parameters& theta) {
    return fmt::format("{:.4f}, {:.4f}", theta[0], theta[1]);
  };
  table all({"delta omega", "energy norm", "printed Sigma, omega = 1", "omega = 10", "omega = 50"}, 0);
  for (const double z : angles) {
    all.add({fmt::format("{:g}", z), both(energy_optimum(z)), both(printed_optimum(z, 1.0)),
             both(printed_optimum(z, 10.0)), both(printed_optimum(z, 50.0))});
  }
  return {
      "Optimal parameters of the linear system",
      "Remark on optimal parameters, section 4.1",
      {value_of_optimum(), independence_of_omega(), independence_of_delta()},
      {"b1* is 1/2 by symmetry in the energy norm: exchanging the stages is b1 -> 1 - b1. beta1* tends to "
       "0.403408 for small steps, the coefficient of McLachlan's method."},
      {{"b1, beta1 at the minimum of the one-step error:", all}},
      {}};
}

namespace {

/// Error of (q, p) at time 1 on q'' = -q after n steps of a two-stage method.
double error_at_one(const two_parameters& at, int n, double beta_sum) {
  const matrix step = one_step(at, 1.0 / n, 1.0, beta_sum);
  matrix all = matrix::Identity();
  for (int i = 0; i < n; ++i) all = (step * all).eval();
  return (all - exact_step(1.0, 1.0, 0.0)).norm();
}

estimate order_of(double beta_sum) {
  std::vector<double> steps;
  std::vector<double> errors;
  for (int n = 64; n <= 1024; n *= 2) {
    steps.push_back(1.0 / n);
    errors.push_back(error_at_one({0.5, 0.4}, n, beta_sum));
  }
  return exponent(steps, errors);
}

}  // namespace

exhibit printed_constraint(const setting&) {
  const estimate as_printed = order_of(1.0);
  const estimate as_in_section_2 = order_of(0.5);
  return {
      "The constraint on beta2",
      "Proposition on the linear system, section 4.1",
      {{"beta2 = 1 - beta1, of a method of second order",
        "order at time 1 for Omega = 1, (b1, beta1) = (0.5, 0.4)",
        fmt::format("{:.3f} with beta2 = 1 - beta1, {:.3f} with 1/2 - beta1", as_printed.mean,
                    as_in_section_2.mean),
        verdict_of(agrees(as_printed, 2.0, 0.2)),
        "the order must be 2 to a tenth; beta1 + beta2 = 1/2 is what section 2 asks for, and is meant", ""}}};
}

namespace {

/// By the printed criterion, and by |lambda| <= 1: the fraction of z^2 in 0..20 that is called stable
/// wrongly.
double wrongly_stable() {
  int wrong = 0;
  constexpr int samples = 2000;
  for (int i = 0; i < samples; ++i) {
    const double z = std::sqrt(20.0 * (i + 0.5) / samples);
    const auto lambda = one_step({0.5, 0.4}, z, 1.0).eigenvalues();
    const bool printed = lambda.real().maxCoeff() <= 1.0 + 1e-9;
    const bool stable = lambda.cwiseAbs().maxCoeff() <= 1.0 + 1e-6;
    wrong += printed && !stable ? 1 : 0;
  }
  return static_cast<double>(wrong) / samples;
}

}  // namespace

exhibit linear_stability(const setting&) {
  const auto windows = stability_of(two_stages(0.5, 0.4));
  const double verlet = limit_of(two_stages(0.5, 0.5));
  const double limit = windows.front().high;
  const std::array second{windows.size() > 1 ? windows[1].low * windows[1].low : 0.0,
                          windows.size() > 1 ? windows[1].high * windows[1].high : 0.0};
  const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-9 * b; };
  const std::string command = "nysalt stability --family nystrom --parameters 0.5,0.4";
  const std::vector<reading> cost{{"a step", limit > verlet}, {"a force evaluation", 0.5 * limit > verlet}};
  const std::vector<reading> criteria{{"|lambda| <= 1", wrongly_stable() == 0.0}};
  return {
      "Largest step of linear stability",
      "Remark on linear stability, section 4.1",
      {{"stable for delta <= sqrt(20/3)/omega at (0.5, 0.40)", "end of the first window of delta omega",
        fmt::format("{:.10f}; sqrt(20/3) = {:.10f}", limit, std::sqrt(20.0 / 3.0)),
        verdict_of(same(limit, std::sqrt(20.0 / 3.0))), "to nine digits", command},
       {"sqrt(5/3) times the limit of Verlet", "ratio of the limits", fmt::format("{:.10f}", limit / verlet),
        verdict_of(same(limit / verlet, std::sqrt(5.0 / 3.0))), "to nine digits", command},
       {"a second window 10 <= z <= 50/3 of z = delta^2 Omega", "the second window of z",
        fmt::format("{:.8f} .. {:.8f}", second[0], second[1]),
        verdict_of(same(second[0], 10.0) && same(second[1], 50.0 / 3.0)), "to nine digits", command},
       {"stable while the real parts of the eigenvalues are at most 1",
        "part of 0 < z < 20 that this calls stable and |lambda| <= 1 does not",
        fmt::format("{:.3f}", wrongly_stable()), verdict_of(wrongly_stable() == 0.0),
        "it must be none; between 20/3 and 10 one eigenvalue is below -1", ""},
       {"the largest step of linear stability is enlarged",
        "limit over that of Verlet, a step and an evaluation",
        fmt::format("{:.4f} and {:.4f}", limit / verlet, 0.5 * limit / verlet),
        verdict_of("what is counted: a step takes two force evaluations, one of Verlet one", cost),
        summary_of(cost), "nysalt stability --method verlet"}}};
}

}  // namespace nysalt::program::paper
