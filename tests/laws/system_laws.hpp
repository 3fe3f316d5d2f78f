// SPDX-License-Identifier: BSL-1.0
// What holds for every system. Each law returns how far it is broken, in units of what rounding may do:
// above 1 it is.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cstring>
#include <vector>

#include "../support/dense.hpp"
#include "../support/rounding.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/references/odeint.hpp"
#include "nysalt/systems/counted.hpp"

namespace nysalt::test {

/// force = -grad V. Each of some 8 operations per coordinate rounds a term of a size up to |V''| |q| + |f|.
template <SeparableSystem S>
double gradient_defect(const S& system, const vector<double, S::dimension>& q) {
  auto f = make_vector<double>(system);
  auto g = f;
  force<double>(system, q, f);
  gradient<double, S::dimension>([&](const auto& x) { return system.potential(x); }, q, -1.0, g);
  const double term = norm(hessian(system, q)) * q.cwiseAbs().maxCoeff() + f.cwiseAbs().maxCoeff();
  return (f - g).cwiseAbs().maxCoeff() / (8.0 * static_cast<double>(q.size()) * eps * term);
}

/// kick is p += c force(q), to the bit: then a run does not depend on where the word may use it.
template <Scalar T, Scalar C, SeparableSystem S>
  requires HasKick<S, T, C>
bool kick_is_force(const S& system, const phase_point<T, S::dimension>& x, const C& c) {
  auto f = make_vector<T>(system);
  force<T>(system, x.q, f);
  auto expected = x.p;
  for (Eigen::Index i = 0; i < f.size(); ++i) expected[i] += f[i] * c;
  auto kicked = x.p;
  system.kick(x.q, kicked, c);
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    if (std::memcmp(&kicked[i], &expected[i], sizeof(T)) != 0) return false;
  }
  return true;
}

/// M^{-1/2} V''(0) M^{-1/2} = U diag(w^2) U^T with orthonormal U. An eigensolver errs by about n eps |V''|;
/// the product of three matrices adds 3 n eps |V''|.
template <SeparableSystem S>
double modes_defect(const S& system, const normal_modes& modes) {
  const Eigen::Index n = size(system);
  auto origin = make_vector<double>(system);
  origin.setZero();
  Eigen::VectorXd root = Eigen::VectorXd::Ones(n);
  if constexpr (HasInverseMass<S>) {
    for (Eigen::Index i = 0; i < n; ++i) root[i] = std::sqrt(system.inverse_mass(i));
  }
  const Eigen::MatrixXd weighted = root.asDiagonal() * hessian(system, origin) * root.asDiagonal();
  const Eigen::MatrixXd diagonal = modes.frequencies.cwiseAbs2().asDiagonal();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd& u = modes.basis;
  const double unit = 8.0 * static_cast<double>(n * n) * eps;
  return std::max(norm(u.transpose() * weighted * u - diagonal) / (unit * norm(weighted)),
                  norm(u.transpose() * u - identity) / unit);
}

/// How far the frequencies of the linearised motion at q are outside the bands, relative to the highest.
/// An eigenvalue errs by n eps |V''|, and its root by the square root of that near zero.
template <SeparableSystem S>
double band_defect(const S& system, const std::vector<frequency_band>& bands,
                   const vector<double, S::dimension>& q) {
  const Eigen::Index n = size(system);
  Eigen::VectorXd root = Eigen::VectorXd::Ones(n);
  if constexpr (HasInverseMass<S>) {
    for (Eigen::Index i = 0; i < n; ++i) root[i] = std::sqrt(system.inverse_mass(i));
  }
  const Eigen::MatrixXd weighted = root.asDiagonal() * hessian(system, q) * root.asDiagonal();
  double worst = 0.0;
  for (const double square : symmetric_eigen(weighted).values) {
    double outside = std::numeric_limits<double>::infinity();  // in squares; a negative one oscillates not
    for (const auto [low, high] : bands) {
      const double x = std::max(square, 0.0);
      outside = std::min(outside, std::max({low * low - x, x - high * high, 0.0}));
    }
    worst = std::max(worst, outside);
  }
  return worst / (8.0 * static_cast<double>(n) * eps * std::max(1.0, norm(weighted)));
}

/// |dH| per unit of error in every coordinate, at x.
template <HasEnergy S>
double energy_slope(const S& system, const phase_point<double, S::dimension>& x) {
  auto f = make_vector<double>(system);
  auto v = f;
  force<double>(system, x.q, f);
  velocity<double>(system, x.p, v);
  return f.cwiseAbs().sum() + v.cwiseAbs().sum();
}

/// Energy along a reference that makes at most `error` in a coordinate per evaluation of the force. The
/// slope of H is taken at both ends, twice as large: it changes on the way.
template <HasEnergy S>
double energy_defect(const S& system, const auto& reference, const phase_point<double, S::dimension>& x,
                     double time, double error) {
  const counted<S> watched(system);
  auto y = x;
  reference.advance(watched, y, time);
  const double allowed = 2.0 * static_cast<double>(watched.evaluations) * error *
                         (energy_slope(system, x) + energy_slope(system, y) + 1.0);
  return std::abs(energy<double>(system, y) - energy<double>(system, x)) / allowed;
}

}  // namespace nysalt::test
