// SPDX-License-Identifier: BSL-1.0
// Where a polynomial turns, and where it takes a value.
#pragma once

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numeric>
#include <vector>

namespace nysalt::detail {

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

/// Beyond this no root of sum_k c[k] x^k lies: 2 max |c_{n-k}/c_n|^{1/k} [fujiwara_1916].
inline double root_bound(const std::vector<double>& c) {
  const std::size_t n = c.size() - 1;
  double bound = 0.0;
  for (std::size_t k = 1; k <= n; ++k) {
    bound = std::max(bound, std::pow(std::abs(c[n - k] / c[n]), 1.0 / static_cast<double>(k)));
  }
  return 2.0 * bound;
}

/// Extrema of f(x), x = z^2, up to x_end, by sampling in z: for polynomials whose coefficients no longer tell
/// their roots. Extrema less than a cell apart may be missed. Boost's search finds them to sqrt(eps).
inline std::vector<double> sampled_extrema(const auto& f, double x_end) {
  const double z_end = std::sqrt(x_end);
  const double cells = std::clamp(z_end / 0.005, 1e3, 1e5);
  const auto at = [&](double k) { return (k / cells * z_end) * (k / cells * z_end); };
  std::vector<double> extrema;
  double before = f(at(0.0));
  double here = f(at(1.0));
  for (double k = 1.0; k < cells; ++k) {
    const double after = f(at(k + 1.0));
    const double sign = here > before ? -1.0 : 1.0;
    if ((here - before) * (after - here) < 0.0) {
      const auto upside_down = [&](double x) { return sign * f(x); };
      extrema.push_back(
          boost::math::tools::brent_find_minima(upside_down, at(k - 1.0), at(k + 1.0), 52).first);
    }
    before = here;
    here = after;
  }
  return extrema;
}

}  // namespace nysalt::detail
