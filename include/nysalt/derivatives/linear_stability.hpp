// SPDX-License-Identifier: BSL-1.0
// For which z = h omega a method is stable on the harmonic oscillator, exactly.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "nysalt/derivatives/stability_window.hpp"
#include "nysalt/derivatives/turning_points.hpp"
#include "nysalt/method.hpp"
#include "nysalt/run_time_word.hpp"
#include "nysalt/scalars/series.hpp"

namespace nysalt {

namespace detail {

/// q'' = -x q with the stiffness x in the scalar of the step; with h = 1 the word's matrix is a polynomial
/// in x = z^2.
template <Scalar T>
struct stiffness_probe {
  static constexpr int dimension = 1;
  T stiffness;
  template <class U>
  void force(const vector<U, 1>& q, vector<U, 1>& f) const {
    f[0] = -(U(stiffness) * q[0]);
  }
};

/// The 2 x 2 matrix of one step, in (q, z p).
template <Scalar T>
struct oscillator_matrix {
  T qq, qp, pq, pp;
  T half_trace() const { return (qq + pp) * 0.5; }
};

template <Word W, Scalar T>
oscillator_matrix<T> matrix_on_oscillator(const W& word, const typename W::template coefficients<double>& c,
                                          const T& x) {
  const stiffness_probe<T> probe{x};
  const stepper<stiffness_probe<T>, W> one(probe, word, c, 1.0);
  phase_point<T, 1> from_q{vector<T, 1>(T(1.0)), vector<T, 1>(T(0.0))};
  phase_point<T, 1> from_p{vector<T, 1>(T(0.0)), vector<T, 1>(T(1.0))};
  one.step(from_q);
  one.step(from_p);
  return {from_q.q[0], from_p.q[0], from_q.p[0], from_p.p[0]};
}

/// Degree of trace/2 in x: the number of evaluations at most.
template <class W>
inline constexpr int stability_degree = 64;
template <TypeLevelWord W>
inline constexpr int stability_degree<W> = static_cast<int>(W::slots);

}  // namespace detail

/// All windows. Their ends are roots of trace/2 = +-1; windows that touch where the matrix is +-I are one.
/// Cost: some thousand steps on an oscillator. Throws std::invalid_argument if a run-time word has more than
/// 64 evaluations a step, or where it rotates.
template <Word W>
stability_chart chart_stability(const W& word,
                                const typename W::template coefficients<double>& coefficients) {
  if (has_rotation(word)) {
    throw std::invalid_argument(fmt::format(
        "the word {} is exact on the oscillator at any step: only its soft part can make it unstable",
        word.letters()));
  }
  constexpr int degree = detail::stability_degree<W>;
  if (word.evaluations_of_plain_step > degree) {
    throw std::invalid_argument(fmt::format("stability is known for words of at most {} evaluations, not {}",
                                            degree, word.evaluations_of_plain_step));
  }
  const auto matrix = [&](const auto& x) { return detail::matrix_on_oscillator(word, coefficients, x); };
  const auto half_trace = [&](double x) { return matrix(x).half_trace(); };

  // trace/2 as a polynomial in x, and the same with nothing cancelling: the measure of its rounding.
  auto magnitudes = coefficients;
  for (double& c : magnitudes) c = std::abs(c);
  const auto polynomial = matrix(series<degree>::variable()).half_trace().coefficient;
  const auto bound =
      detail::matrix_on_oscillator(word, magnitudes, -series<degree>::variable()).half_trace().coefficient;
  const double rounding = 8.0 * static_cast<double>(word.slots) * std::numeric_limits<double>::epsilon();
  std::vector<double> slope;
  std::size_t terms = 0;
  for (std::size_t k = 1; k < polynomial.size(); ++k) {
    const bool vanishes = std::abs(polynomial[k]) <= rounding * bound[k];
    slope.push_back(vanishes ? 0.0 : static_cast<double>(k) * polynomial[k]);
    if (!vanishes) terms = k;
  }
  if (terms == 0) return {};  // no letter moves the oscillator

  while (slope.back() == 0.0) slope.pop_back();

  // Between extrema trace/2 is monotone, and beyond the last it leaves [-1, 1] for good.
  constexpr std::size_t few = 8;  // of more kicks the coefficients no longer tell the extrema
  const bool is_short = slope.size() <= few;
  const double beyond = std::max(1.0, slope.size() > 1 ? detail::root_bound(slope) : 0.0);
  std::vector<double> pieces =
      is_short ? detail::positive_roots(slope) : detail::sampled_extrema(half_trace, beyond);
  pieces.insert(pieces.begin(), 0.0);
  double last = 2.0 * beyond;
  while (std::abs(half_trace(last)) < 2.0) last *= 2.0;
  pieces.push_back(last);

  // An extremum within rounding of +-1 only touches it.
  const auto touches = [&](double x, double value) {
    double size = 0.0;
    for (std::size_t k = bound.size(); k-- > 0;) size = size * x + bound[k];
    return std::abs(std::abs(value) - 1.0) <= (is_short ? rounding * size : 1e-10);
  };
  std::vector<double> edges{0.0};
  double at_a = 1.0;
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    const double a = pieces[i];
    const double b = pieces[i + 1];
    double at_b = half_trace(b);
    if (b < last && touches(b, at_b)) {
      at_b = std::copysign(1.0, at_b);
      edges.push_back(b);
    }
    const auto [least, most] = std::minmax({at_a, at_b});
    for (const double y : {-1.0, 1.0}) {
      if (least < y && y < most) edges.push_back(detail::bisect(half_trace, a, b, y));
    }
    at_a = at_b;
  }
  std::sort(edges.begin(), edges.end());

  stability_chart chart;
  auto& windows = chart.windows;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double low = edges[i];
    const double high = edges[i + 1];
    if (!(std::abs(half_trace(std::midpoint(low, high))) < 1.0)) continue;
    const auto m = matrix(low);
    // At an extremum that is known to e of the trace, what is off the diagonal errs by sqrt(2 e).
    const double z = std::sqrt(low);
    const bool identity = std::max(std::abs(m.qp) * z, std::abs(m.pq) / z) < (is_short ? 1e-7 : 2e-5);
    const bool adjoins = !windows.empty() && windows.back().high == low;
    if (adjoins && identity) {
      windows.back().high = high;
      chart.touching.push_back(z);
    } else {
      windows.push_back({low, high});
    }
  }
  for (auto& window : windows) window = {std::sqrt(window.low), std::sqrt(window.high)};
  return chart;
}

/// The windows of chart_stability() alone.
template <Word W>
std::vector<stability_window> stability_windows(
    const W& word, const typename W::template coefficients<double>& coefficients) {
  return chart_stability(word, coefficients).windows;
}

/// The windows of a method, at its own coefficients.
template <Method M>
std::vector<stability_window> stability_windows(const M& method) {
  return stability_windows(word_of(method), method.coefficients());
}

/// End of the window that begins at z = 0; 0 where there is none.
template <Method M>
double stability_limit(const M& method) {
  const auto windows = stability_windows(method);
  return windows.empty() || windows.front().low > 0.0 ? 0.0 : windows.front().high;
}

}  // namespace nysalt
