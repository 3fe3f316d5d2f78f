// SPDX-License-Identifier: BSL-1.0
// For which z = h omega a method is stable on the harmonic oscillator, exactly.
#pragma once

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "nysalt/method.hpp"
#include "nysalt/scalars/series.hpp"

namespace nysalt {

/// Stable for low <= z <= high, but for a single point where the matrix is a Jordan block.
struct stability_window {
  double low;
  double high;
};

namespace detail {

/// q'' = -x q with the stiffness x in the scalar of the step; with h = 1 the word's matrix is a polynomial
/// in x = z^2.
template <Scalar T>
struct stiffness_probe {
  static constexpr int dimension = 1;
  T stiffness;
  void force(const vector<T, 1>& q, vector<T, 1>& f) const { f[0] = -(stiffness * q[0]); }
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
inline constexpr int stability_degree<W> = static_cast<int>(W::length);

/// Real parts of the nearly real, positive roots of sum_k c[k] x^k, by the companion matrix.
inline std::vector<double> positive_roots(std::vector<double> c) {
  while (!c.empty() && c.back() == 0.0) c.pop_back();
  const auto degree = static_cast<Eigen::Index>(c.size()) - 1;
  std::vector<double> roots;
  if (degree < 1) return roots;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  companion.diagonal(-1).setOnes();
  for (Eigen::Index i = 0; i < degree; ++i)
    companion(i, degree - 1) = -c[static_cast<std::size_t>(i)] / c.back();
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(companion, false);
  for (const auto& root : solver.eigenvalues()) {
    // A root too many only cuts an interval in two, so be generous with nearly double ones.
    if (root.real() > 0.0 && std::abs(root.imag()) <= 1e-3 * root.real()) roots.push_back(root.real());
  }
  std::sort(roots.begin(), roots.end());
  return roots;
}

/// Where a function that is monotone on [a, b] takes the value y, to the last bit; f(a) and f(b) enclose y.
inline double bisect(const auto& f, double a, double b, double y) {
  const bool rising = f(a) < y;
  for (double m = std::midpoint(a, b); m != a && m != b; m = std::midpoint(a, b)) {
    ((f(m) < y) == rising ? a : b) = m;
  }
  return a;
}

}  // namespace detail

/// All windows, from small z to large. Their ends are roots of trace/2 = +-1; windows that touch where the
/// matrix is +-I are one. Cost: some thousand steps on an oscillator.
/// Throws std::invalid_argument if a run-time word has more than 64 evaluations a step.
template <Word W>
std::vector<stability_window> stability_windows(
    const W& word, const typename W::template coefficients<double>& coefficients) {
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
  const double rounding = 8.0 * static_cast<double>(word.length) * std::numeric_limits<double>::epsilon();
  std::vector<double> slope;
  std::size_t terms = 0;
  for (std::size_t k = 1; k < polynomial.size(); ++k) {
    const bool vanishes = std::abs(polynomial[k]) <= rounding * bound[k];
    slope.push_back(vanishes ? 0.0 : static_cast<double>(k) * polynomial[k]);
    if (!vanishes) terms = k;
  }
  if (terms == 0) return {};  // no letter moves the oscillator

  // Between extrema trace/2 is monotone, and beyond the last it leaves [-1, 1] for good.
  std::vector<double> pieces = detail::positive_roots(slope);
  pieces.insert(pieces.begin(), 0.0);
  double last = std::max(1.0, 2.0 * pieces.back());
  while (std::abs(half_trace(last)) < 2.0) last *= 2.0;
  pieces.push_back(last);

  std::vector<double> edges{0.0};
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    const double a = pieces[i];
    const double b = pieces[i + 1];
    const double at_a = half_trace(a);
    const double at_b = half_trace(b);
    const auto [least, most] = std::minmax({at_a, at_b});
    for (const double y : {-1.0, 1.0}) {
      if (least < y && y < most) edges.push_back(detail::bisect(half_trace, a, b, y));
    }
    if (b == last) break;
    double size_at_b = 0.0;
    for (std::size_t k = bound.size(); k-- > 0;) size_at_b = size_at_b * b + bound[k];
    if (std::abs(std::abs(at_b) - 1.0) <= rounding * size_at_b) edges.push_back(b);
  }
  std::sort(edges.begin(), edges.end());

  std::vector<stability_window> windows;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double low = edges[i];
    const double high = edges[i + 1];
    if (!(std::abs(half_trace(std::midpoint(low, high))) < 1.0)) continue;
    const auto m = matrix(low);
    // An extremum is known to about sqrt(eps); off the diagonal the matrix then errs by as much.
    const double z = std::sqrt(low);
    const bool identity = std::max(std::abs(m.qp) * z, std::abs(m.pq) / z) < 1e-7;
    const bool touches = !windows.empty() && windows.back().high == low;
    if (touches && identity) {
      windows.back().high = high;
    } else {
      windows.push_back({low, high});
    }
  }
  for (auto& window : windows) window = {std::sqrt(window.low), std::sqrt(window.high)};
  return windows;
}

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

/// Whether all z in low..high lie in one window.
inline bool is_stable(const std::vector<stability_window>& windows, double low, double high) {
  return std::any_of(windows.begin(), windows.end(),
                     [&](const auto& window) { return window.low <= low && high <= window.high; });
}

}  // namespace nysalt
