// SPDX-License-Identifier: BSL-1.0
// What rounding may do: the ingredients of tolerances, so that none is guessed.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "nysalt/method.hpp"

namespace nysalt::test {

inline constexpr double eps = std::numeric_limits<double>::epsilon();

/// Largest absolute row sum: how much a matrix can magnify the largest coordinate.
inline double norm(const Eigen::MatrixXd& a) { return a.cwiseAbs().rowwise().sum().maxCoeff(); }

template <int N>
double size_of(const phase_point<double, N>& x) {
  return std::max({1.0, x.q.cwiseAbs().maxCoeff(), x.p.cwiseAbs().maxCoeff()});
}

template <int N>
double distance(const phase_point<double, N>& x, const phase_point<double, N>& y) {
  return std::max((x.q - y.q).cwiseAbs().maxCoeff(), (x.p - y.p).cwiseAbs().maxCoeff());
}

template <int N>
bool same_bits(const phase_point<double, N>& x, const phase_point<double, N>& y) {
  return x.q == y.q && x.p == y.p;
}

/// Derivative of a map of vectors that is given over any scalar: map(x, result).
template <int N>
Eigen::MatrixXd derivative(const auto& map, const vector<double, N>& x) {
  using D = dual<double, 1>;
  vector<D, N> argument(x.size());
  vector<D, N> result(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) argument[i] = D(x[i]);
  Eigen::MatrixXd columns(x.size(), x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    argument[k] = D::variable(x[k], 0);
    map(argument, result);
    argument[k] = D(x[k]);
    for (Eigen::Index i = 0; i < x.size(); ++i) columns(i, k) = result[i].derivative[0];
  }
  return columns;
}

/// The Hessian of V at q, from the force.
template <SeparableSystem S>
Eigen::MatrixXd hessian(const S& system, const vector<double, S::dimension>& q) {
  const auto minus = [&](const auto& x, auto& f) { force<dual<double, 1>>(system, x, f); };
  return -derivative(minus, q);
}

/// Sizes of the second derivatives of V and K around a state: what kicks and drifts shear with.
struct shears {
  double potential;
  double kinetic;
  double frequency() const { return std::max(1.0, std::sqrt(potential * kinetic)); }
};
template <SeparableSystem S>
shears shears_at(const S& system, const phase_point<double, S::dimension>& x) {
  const auto rate = [&](const auto& p, auto& v) { velocity<dual<double, 1>>(system, p, v); };
  return {norm(hessian(system, x.q)), norm(derivative(rate, x.p))};
}

/// How much the letters of one step can magnify a perturbation: the product of 1 + |c h| |shear| over
/// them, with shears twice as large as at the start, since the state moves. Those of the bath do not magnify.
template <Method M>
double magnification(const M& method, double step, const shears& at) {
  double product = 1.0;
  const std::string letters = M::word::letters();
  const auto c = method.coefficients();
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (letters[i] == 'O') continue;
    product *= 1.0 + 2.0 * std::abs(c[i] * step) * (letters[i] == 'B' ? at.potential : at.kinetic);
  }
  return product;
}

}  // namespace nysalt::test
