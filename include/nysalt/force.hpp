// SPDX-License-Identifier: BSL-1.0
// f = -grad V over any scalar: the system's own, by automatic differentiation, or from a black box.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "nysalt/system.hpp"

namespace nysalt {

/// result = sign * grad function at x, by automatic differentiation of function(vector) -> scalar.
/// Cost: 1 evaluation over dual<T, N> for small fixed N, else N evaluations over dual<T, 1>.
template <class T, int N>
void gradient(const auto& function, const vector<T, N>& x, double sign, vector<T, N>& result) {
  constexpr int width = detail::sweep<N>;
  using D = dual<T, width>;
  vector<D, N> lifted(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) lifted[i] = D(x[i]);
  for (Eigen::Index first = 0; first < x.size(); first += width) {
    for (int k = 0; k < width; ++k) lifted[first + k] = D::variable(x[first + k], k);
    const D value = function(lifted);
    for (int k = 0; k < width; ++k) {
      result[first + k] = sign * value.derivative[static_cast<std::size_t>(k)];
      lifted[first + k] = D(x[first + k]);
    }
  }
}

/// g = f'(q) v of a black-box force: the system's own, or central differences with an error of order
/// eps^(2/3) relative to |f|/|q| (two evaluations).
template <System S>
  requires HasForce<S, double>
void directional_derivative(const S& system, const vector<double, S::dimension>& q,
                            const vector<double, S::dimension>& v, vector<double, S::dimension>& g) {
  if constexpr (HasForceDerivative<S>) {
    system.force_derivative(q, v, g);
  } else {
    double length = 0.0;
    double scale = 1.0;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      length = std::max(length, std::abs(v[i]));
      scale = std::max(scale, std::abs(q[i]));
    }
    for (Eigen::Index i = 0; i < q.size(); ++i) g[i] = 0.0;
    if (length == 0.0) return;
    // The optimal step of a central difference balances eps/s against s^2.
    const double s = std::cbrt(std::numeric_limits<double>::epsilon()) * scale / length;
    auto ahead = q;
    auto behind = q;
    auto f_behind = q;
    for (Eigen::Index i = 0; i < q.size(); ++i) ahead[i] += s * v[i];
    for (Eigen::Index i = 0; i < q.size(); ++i) behind[i] -= s * v[i];
    system.force(ahead, g);
    system.force(behind, f_behind);
    for (Eigen::Index i = 0; i < q.size(); ++i) g[i] = (g[i] - f_behind[i]) / (2.0 * s);
  }
}

/// f = -grad V(q) over any scalar that the system can serve.
/// Cost: the system's own force where it has one over T. From the potential that of gradient(), and from a
/// black box 1 force and T::derivatives directional derivatives; of a dynamic dimension these two allocate at
/// every call, so that a system that must be fast writes its force as a template.
template <class T, SystemOver<T> S>
void force(const S& system, const vector<T, S::dimension>& q, vector<T, S::dimension>& f) {
  if constexpr (HasForce<S, T>) {
    system.force(q, f);
  } else if constexpr (HasPotential<S, dual<T, detail::sweep<S::dimension>>>) {
    gradient<T, S::dimension>([&](const auto& x) { return system.potential(x); }, q, -1.0, f);
  } else {  // a black box over dual<double, N>: f(q + e v) = f(q) + e f'(q) v
    auto value = make_vector<double>(system);
    auto direction = value;
    auto result = value;
    for (Eigen::Index i = 0; i < q.size(); ++i) value[i] = q[i].value;
    system.force(value, result);
    for (Eigen::Index i = 0; i < q.size(); ++i) f[i].value = result[i];
    for (std::size_t k = 0; k < T::derivatives; ++k) {
      for (Eigen::Index i = 0; i < q.size(); ++i) direction[i] = q[i].derivative[k];
      directional_derivative(system, value, direction, result);
      for (Eigen::Index i = 0; i < q.size(); ++i) f[i].derivative[k] = result[i];
    }
  }
}

/// Which force a kick reads: that of V, or of V without its quadratic part.
enum class field { none, whole, soft };

/// The force of a field can be evaluated over T.
template <class S, class T, field F>
concept ForceOver = (F == field::whole && SystemOver<S, T>) || (F == field::soft && HasSoftForce<S, T>);

/// The force of a field. Cost: one evaluation.
template <field F, class T, System S>
  requires ForceOver<S, T, F>
void force_of(const S& system, const vector<T, S::dimension>& q, vector<T, S::dimension>& f) {
  if constexpr (F == field::soft) {
    system.soft_force(q, f);
  } else {
    force<T>(system, q, f);
  }
}

/// f'(q) v of a field can be had over T.
template <class S, class T, field F>
concept ForceDerivativeOver = ForceOver<S, dual<T, 1>, F> ||
    (F == field::whole && (HasForceDerivative<S, T> || (BlackBoxForce<S> && detail::is_dual_of_double<T>)));

/// Room for a force over dual numbers.
template <class T, int N>
struct lifted_room {
  lifted_room() = default;
  explicit lifted_room(Eigen::Index size) : q(size), f(size) {}  ///< for so many degrees of freedom
  vector<dual<T, 1>, N> q;                                       ///< q + e v, e being the dual unit
  vector<dual<T, 1>, N> f;                                       ///< f(q) + e f'(q) v
};

namespace detail {

/// Of a black box, over dual numbers: f'(q) v, and f''(q)[dq, v] + f'(q) dv by central differences. Where
/// f'(q) v is one itself, the derivatives have an error of order eps^(1/3).
template <class T, System S>
void black_box_along(const S& system, const vector<T, S::dimension>& q, const vector<T, S::dimension>& v,
                     vector<T, S::dimension>& g) {
  const Eigen::Index n = q.size();
  auto at = make_vector<double>(system);
  auto along = at;
  auto ahead = at;
  auto behind = at;
  const auto difference = [&](double s, std::size_t k, vector<double, S::dimension>& result) {
    for (Eigen::Index i = 0; i < n; ++i) at[i] = q[i].value + s * q[i].derivative[k];
    for (Eigen::Index i = 0; i < n; ++i) along[i] = v[i].value + s * v[i].derivative[k];
    directional_derivative(system, at, along, result);
  };
  difference(0.0, 0, ahead);
  for (Eigen::Index i = 0; i < n; ++i) g[i].value = ahead[i];
  for (std::size_t k = 0; k < T::derivatives; ++k) {
    double length = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      length = std::max({length, std::abs(q[i].derivative[k]), std::abs(v[i].derivative[k])});
    }
    const double s = std::cbrt(std::numeric_limits<double>::epsilon()) / std::max(length, 1.0);
    difference(s, k, ahead);
    difference(-s, k, behind);
    for (Eigen::Index i = 0; i < n; ++i) g[i].derivative[k] = (ahead[i] - behind[i]) / (2.0 * s);
  }
}

}  // namespace detail

/// g = f'(q) v of a field over any scalar: the system's own, or exactly by a dual number, and of a black box
/// by differences. Cost: one evaluation, as `counted` counts it; over dual<double, N> a black box takes 2 N
/// more.
template <field F, class T, System S>
  requires ForceDerivativeOver<S, T, F>
void force_along(const S& system, const vector<T, S::dimension>& q, const vector<T, S::dimension>& v,
                 vector<T, S::dimension>& g, lifted_room<T, S::dimension>& room) {
  if constexpr (F == field::whole && HasForceDerivative<S, T>) {
    system.force_derivative(q, v, g);
  } else if constexpr (F == field::whole && BlackBoxForce<S>) {
    if constexpr (is_dual<T>) {
      detail::black_box_along<T>(system, q, v, g);
    } else {
      directional_derivative(system, q, v, g);
    }
  } else {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      room.q[i].value = q[i];
      room.q[i].derivative[0] = v[i];
    }
    force_of<F, dual<T, 1>>(system, room.q, room.f);
    for (Eigen::Index i = 0; i < q.size(); ++i) g[i] = room.f[i].derivative[0];
  }
}

/// How derivatives of the force come about, for reports.
template <SeparableSystem S>
constexpr const char* derivative_source() {
  if constexpr (!BlackBoxForce<S>) return "automatic differentiation";
  if constexpr (HasForceDerivative<S>) return "the system's directional derivative";
  return "central differences of the force";
}

}  // namespace nysalt
