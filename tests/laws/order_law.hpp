// SPDX-License-Identifier: BSL-1.0
// The order of a method, measured.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "../support/rounding.hpp"
#include "nysalt/references/odeint.hpp"

namespace nysalt::test {

/// Starts, and where they are a time later by a reference that shares nothing with our steps.
template <int N>
struct solved {
  std::vector<phase_point<double, N>> start;
  std::vector<phase_point<double, N>> finish;
  double time;
};

template <SeparableSystem S>
solved<S::dimension> solve(const S& system, std::vector<phase_point<double, S::dimension>> starts,
                           double time) {
  solved<S::dimension> result{starts, std::move(starts), time};
  for (auto& x : result.finish) odeint_reference(1e-15).advance(system, x, time);
  return result;
}

/// A word and its coefficients, wherever their order holds.
struct table {
  run_time_word word;
  std::vector<double> coefficients;
};
template <Method M>
table table_of(const M& method) {
  const auto c = method.coefficients();
  return {run_time_word(word_of(method).letters()), {c.begin(), c.end()}};
}

/// Root mean square error over the starts after the whole time in that many steps.
template <SeparableSystem S>
double error_in(std::int64_t steps, const S& system, const table& method,
                const solved<S::dimension>& problem) {
  const stepper<S, run_time_word> fixed(system, method.word, method.coefficients,
                                        problem.time / static_cast<double>(steps));
  double sum = 0.0;
  for (std::size_t k = 0; k < problem.start.size(); ++k) {
    auto run = fixed.open(problem.start[k]);
    fixed.advance(run, steps);
    const auto x = fixed.synchronous(run);
    sum += (x.q - problem.finish[k].q).squaredNorm() + (x.p - problem.finish[k].p).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(problem.start.size()));
}

/// Slope of log error against log step over the last halving that rounding does not spoil. The run's
/// rounding errors add up like a random walk, sqrt(n letters) eps, and the reference's like its some 8 steps
/// of 5e-15 a unit of time. An error 50 times as large is known to 2 %, which moves the slope by 0.03. What
/// remains of higher orders moves it by about (w h)^2 for symmetric methods and by w h otherwise. Hence the
/// measure agrees with the order to +-0.15 if the last w h is below 0.35, that is, from steps of 1/4 on.
/// method_at(h) is the method at the step h.
template <SeparableSystem S>
double measured_order(const S& system, const auto& method_at, const solved<S::dimension>& problem,
                      std::int64_t steps) {
  const auto error_after = [&](std::int64_t n) {
    return error_in(n, system, method_at(problem.time / static_cast<double>(n)), problem);
  };
  double coarse = error_after(steps);
  for (double slope = 0.0;; steps *= 2) {
    const double fine = error_after(2 * steps);
    const double letters = roundings(method_at(problem.time).word.letters(), size(system));
    const double rounding =
        std::sqrt(static_cast<double>(2 * steps) * letters) * eps + 5e-15 * std::sqrt(8.0 * problem.time);
    if (steps > 2000 || !(fine > 50.0 * rounding)) return slope;
    slope = std::log2(coarse / fine);
    coarse = fine;
  }
}
template <SeparableSystem S>
double measured_order(const S& system, const table& method, const solved<S::dimension>& problem,
                      std::int64_t steps) {
  return measured_order(
      system, [&](double) { return method; }, problem, steps);
}

}  // namespace nysalt::test
