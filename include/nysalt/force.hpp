// SPDX-License-Identifier: BSL-1.0
// f = -grad V over any scalar: the system's own, by automatic differentiation, or from a black box.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include "nysalt/system.hpp"

namespace nysalt {

namespace detail {
/// Whether numbers need no construction before a copy of another is assigned.
template <class T>
inline constexpr bool is_plain_number =
    std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>;

/// A vector of numbers that are to be written.
template <class T, int N>
struct vector_to_fill {
  explicit vector_to_fill(Eigen::Index size) : entries(size) {}
  vector<T, N> entries;
};
/// One of a fixed dimension lies on the stack, unconstructed, also where Eigen's own constructor refuses its
/// size (EIGEN_STACK_ALLOCATION_LIMIT, 128 KB: 13 dual numbers of 13 derivatives over 16 lanes with 8
/// derivatives are 210 KB).
template <class T, int N>
  requires(N != Eigen::Dynamic && is_plain_number<T>)
struct vector_to_fill<T, N> {
  explicit vector_to_fill(Eigen::Index) {}
  union {
    vector<T, N> entries;
  };
};
}  // namespace detail

/// result = sign * grad function at x, by automatic differentiation of function(vector) -> scalar.
/// Cost: 1 evaluation over dual<T, N> for small fixed N, else N evaluations over dual<T, 1>.
template <class T, int N>
void gradient(const auto& function, const vector<T, N>& x, double sign, vector<T, N>& result) {
  constexpr int width = detail::sweep<N>;
  using D = dual<T, width>;
  detail::vector_to_fill<D, N> room(x.size());
  auto& lifted = room.entries;
  for (Eigen::Index i = 0; i < x.size(); ++i) std::construct_at(&lifted[i], x[i]);
  for (Eigen::Index first = 0; first < x.size(); first += width) {
    for (int k = 0; k < width; ++k) lifted[first + k] = D::variable(x[first + k], k);
    const D value = function(lifted);
    for (int k = 0; k < width; ++k) {
      result[first + k] = sign * value.derivative[static_cast<std::size_t>(k)];
      lifted[first + k] = D(x[first + k]);
    }
  }
}

namespace detail {

/// Of a displacement that the motion makes in a step or so, the part that central differences go. A force
/// that bends over lengths L differs by s^2/(6 L^2) from its tangent, and rounding adds eps/s of the force:
/// for s from 1e-8 L to 7e-4 L both are below 1e-7, and this lies in the middle for displacements from 1e-3 L
/// to L.
inline constexpr double part_of_displacement = 5e-5;

/// g = f'(q) v of a black box: its own, or (f(q + s v) - f(q - s v))/(2 s). Cost: 1 call, or 2.
template <System S>
  requires HasForce<S, double>
void black_box_derivative(const S& system, const vector<double, S::dimension>& q,
                          const vector<double, S::dimension>& v, double s, vector<double, S::dimension>& g) {
  if constexpr (HasForceDerivative<S>) {
    system.force_derivative(q, v, g);
  } else {
    for (Eigen::Index i = 0; i < q.size(); ++i) g[i] = 0.0;
    if (s == 0.0) return;
    auto at = q;
    auto f_behind = q;
    for (Eigen::Index i = 0; i < q.size(); ++i) at[i] = q[i] + s * v[i];
    system.force(at, g);
    for (Eigen::Index i = 0; i < q.size(); ++i) at[i] = q[i] - s * v[i];
    system.force(at, f_behind);
    for (Eigen::Index i = 0; i < q.size(); ++i) g[i] = (g[i] - f_behind[i]) / (2.0 * s);
  }
}

/// Rounding errors of a force, some hundred times, and more where q is far from the origin.
inline constexpr double noise_of_forces = 1e4 * std::numeric_limits<double>::epsilon();

/// result = d/ds value_at(s, vector) at 0 by central differences, `middle` being the value there. The step is
/// part_of_displacement at first. It rises, up to `farthest`, while the first difference is hardly above the
/// `noise` of values. Where the second difference is more than a small part of the first, and more than
/// noise, or the first nearly as large as the value itself, as it is where the displacement is far too long,
/// the step falls until the slopes at two steps agree, or agree no better. Entries are summed with the
/// weights |v_i|, so that no unit of a coordinate matters. Cost: 2 values for each step that is tried.
template <class V>
void adapted_difference(const auto& value_at, const V& middle, const V& v, double noise, double farthest,
                        V& result) {
  constexpr double bent = 3e-4;    // of a sine, s = 6e-4 L: the error s^2/(6 L^2) is below 1e-7
  constexpr double agreed = 1e-5;  // with ten times the step: the error is a hundredth of that
  constexpr double noisy = 0.03;   // what agrees as well as that, and no better at a smaller step
  constexpr int most = 40;         // powers of ten
  double s = part_of_displacement;
  double least_change = std::numeric_limits<double>::infinity();
  V behind = middle;
  V before = middle;
  V best = middle;
  bool has_fallen = false;
  for (int n = 0; n < most; ++n) {
    value_at(s, result);
    value_at(-s, behind);
    double size = 0.0;
    double first = 0.0;
    double second = 0.0;
    double slope = 0.0;
    double change = 0.0;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      size += std::abs(v[i] * middle[i]);
      first += std::abs(v[i] * (result[i] - behind[i]));
      second += std::abs(v[i] * (result[i] - 2.0 * middle[i] + behind[i]));
      result[i] = (result[i] - behind[i]) / (2.0 * s);
      slope += std::abs(v[i] * result[i]);
      change += std::abs(v[i] * (result[i] - before[i]));
    }
    const bool is_bent = second > bent * first && second > noise;
    const bool is_far = first > 0.1 * size && first > noise;
    if (is_bent || is_far) {
      if (has_fallen) {
        if (change <= agreed * slope) return;
        if (change < least_change * slope) {
          least_change = change / slope;
          best = result;
        } else if (least_change < noisy) {
          break;
        }
      }
      before = result;
      has_fallen = true;
      s *= 0.1;
    } else if (first < 1e5 * noise && !has_fallen && 10.0 * s <= farthest) {
      s *= 10.0;
    } else {
      return;
    }
  }
  if (least_change < std::numeric_limits<double>::infinity()) result = best;
}

/// How many times v, displacements may be without going beyond 1e-4 of where q is.
template <class V>
double farthest_from(const V& q, const V& v) {
  const double length = v.cwiseAbs().maxCoeff();
  return length > 0.0 ? 1e-4 * q.cwiseAbs().maxCoeff() / length : 0.0;
}

/// g = f'(q) v of a black box, where f = f(q) is known: the system's own, or central differences. For v of
/// the size of what q does in a step or so the error is below 1e-7 of f'(q) v in any units, if q is no more
/// than some 10^4 times that from the origin; a v that is far too long or short is found out and costs more.
/// Cost: 1 call of force_derivative, or 2 of the force, and 2 more for each power of ten by which v is off.
template <System S>
  requires HasForce<S, double>
void directional_derivative(const S& system, const vector<double, S::dimension>& q,
                            const vector<double, S::dimension>& v, const vector<double, S::dimension>& f,
                            vector<double, S::dimension>& g) {
  if constexpr (HasForceDerivative<S>) {
    system.force_derivative(q, v, g);
  } else {
    auto at = q;
    const auto force_at = [&](double s, vector<double, S::dimension>& result) {
      for (Eigen::Index i = 0; i < q.size(); ++i) at[i] = q[i] + s * v[i];
      system.force(at, result);
    };
    const double noise = detail::noise_of_forces * v.cwiseAbs().dot(f.cwiseAbs());
    detail::adapted_difference(force_at, f, v, noise, detail::farthest_from(q, v), g);
  }
}

}  // namespace detail

/// f = -grad V(q) over any scalar that the system can serve.
/// Cost: the system's own force where it has one over T. From the potential the cost of gradient(), and from
/// a black box 1 force and T::derivatives directional derivatives, whose displacements are the derivatives of
/// q; of a dynamic dimension these two allocate at every call, so that a system that must be fast writes its
/// force as a template.
template <class T, SystemOver<T> S>
void force(const S& system, const vector<T, S::dimension>& q, vector<T, S::dimension>& f) {
  if constexpr (HasForce<S, T>) {
    system.force(q, f);
  } else if constexpr (HasPotential<S, dual<T, detail::sweep<S::dimension>>>) {
    gradient<T, S::dimension>([&](const auto& x) { return system.potential(x); }, q, -1.0, f);
  } else {  // a black box over dual<double, N>: f(q + e v) = f(q) + e f'(q) v
    auto at = detail::make_vector<double>(system);
    auto value = at;
    auto direction = at;
    auto result = at;
    for (Eigen::Index i = 0; i < q.size(); ++i) at[i] = q[i].value;
    system.force(at, value);
    for (Eigen::Index i = 0; i < q.size(); ++i) f[i].value = value[i];
    for (std::size_t k = 0; k < T::derivatives; ++k) {
      for (Eigen::Index i = 0; i < q.size(); ++i) direction[i] = q[i].derivative[k];
      detail::directional_derivative(system, at, direction, value, result);
      for (Eigen::Index i = 0; i < q.size(); ++i) f[i].derivative[k] = result[i];
    }
  }
}

/// The force that a kick reads: the force of V, or of V without its quadratic part.
enum class field { none, whole, soft };

/// The force of a field can be evaluated over T.
template <class S, class T, field F>
concept ForceOver = (F == field::whole && SystemOver<S, T>) || (F == field::soft && HasSoftForce<S, T>);

namespace detail {

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

}  // namespace detail

/// f'(q) v of a field can be had over T.
template <class S, class T, field F>
concept ForceDerivativeOver =
    ForceOver<S, dual<T, 1>, F> ||
    (F == field::whole && (HasForceDerivative<S, T> || (BlackBoxForce<S> && detail::is_dual_of_double<T>))) ||
    (ErasedSystem<S> && HasForce<S, T>);

namespace detail {

/// Room for a force over dual numbers.
template <class T, int N>
struct lifted_room {
  lifted_room() = default;
  explicit lifted_room(Eigen::Index size)
      : q(size), f(size) {}  ///< work space for a number of degrees of freedom
  vector<dual<T, 1>, N> q;   ///< q + e v, e being the dual unit
  vector<dual<T, 1>, N> f;   ///< f(q) + e f'(q) v
};

/// Of a black box, over dual numbers: f'(q) v, and f''(q)[dq, v] + f'(q) dv by central differences, where q
/// goes along dq and v along dv. Where f'(q) v, between q + s v and q - s v, is a difference itself, errors
/// are of order sqrt(eps).
template <class T, System S>
void black_box_along(const S& system, const vector<T, S::dimension>& q, const vector<T, S::dimension>& v,
                     double s, vector<T, S::dimension>& g) {
  const Eigen::Index n = q.size();
  auto value = make_vector<double>(system);
  auto at = value;
  auto along = value;
  auto moved = value;
  auto result = value;
  // Differences of differences are both longer, so that rounding, eps/s^2, stays below 1e-9.
  constexpr double longer = HasForceDerivative<S> ? 1.0 : 10.0;
  constexpr double noise_of_slopes = HasForceDerivative<S> ? noise_of_forces : noise_of_forces / longer;
  for (Eigen::Index i = 0; i < n; ++i) at[i] = q[i].value;
  for (Eigen::Index i = 0; i < n; ++i) along[i] = v[i].value;
  black_box_derivative(system, at, along, s, value);
  for (Eigen::Index i = 0; i < n; ++i) g[i].value = value[i];
  auto size = value;  // of what rounding errors of a derivative are relative to
  if constexpr (!HasForceDerivative<S>) {
    black_box_derivative(system, at, along, longer * s, value);
    system.force(at, size);
    size /= s;
  }
  for (std::size_t k = 0; k < T::derivatives; ++k) {
    for (Eigen::Index i = 0; i < n; ++i) moved[i] = longer * q[i].derivative[k];
    const auto derivative_at = [&](double t, vector<double, S::dimension>& found) {
      for (Eigen::Index i = 0; i < n; ++i) at[i] = q[i].value + t * moved[i];
      for (Eigen::Index i = 0; i < n; ++i) along[i] = v[i].value + longer * t * v[i].derivative[k];
      black_box_derivative(system, at, along, longer * s, found);
    };
    const double noise = noise_of_slopes * moved.cwiseAbs().dot(size.cwiseAbs());
    adapted_difference(derivative_at, value, moved, noise, 0.0, result);
    for (Eigen::Index i = 0; i < n; ++i) g[i].derivative[k] = result[i] / longer;
  }
}

/// g = f'(q) v of a field over any scalar: the system's own, or exactly by a dual number, and of a black box
/// by differences between q + s v and q - s v. If v is what q does in a step or so, s may be left out. Cost:
/// one evaluation; of a black box as many calls as derivative_calls says, and over dual<double, N> 4 N + 3
/// more or some, 2 N of a force_derivative.
template <field F, class T, System S>
  requires ForceDerivativeOver<S, T, F>
void force_along(const S& system, const vector<T, S::dimension>& q, const vector<T, S::dimension>& v,
                 vector<T, S::dimension>& g, auto& room, double s = detail::part_of_displacement) {
  if constexpr (F == field::whole && HasForceDerivative<S, T>) {
    system.force_derivative(q, v, g);
  } else if constexpr (F == field::whole && BlackBoxForce<S>) {
    if constexpr (is_dual<T>) {
      detail::black_box_along<T>(system, q, v, s, g);
    } else {
      detail::black_box_derivative(system, q, v, s, g);
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

/// Evaluations that f'(q) v costs in a gradient kick: calls of a black box, which takes differences of two,
/// and else one.
template <System S>
inline constexpr int derivative_calls = BlackBoxForce<S> && !HasForceDerivative<S> ? 2 : 1;

/// Origin of the derivatives of the force, for reports.
template <SeparableSystem S>
constexpr const char* derivative_source() {
  if constexpr (!BlackBoxForce<S>) return "automatic differentiation";
  if constexpr (HasForceDerivative<S>) return "the system's directional derivative";
  return "central differences of the force";
}

}  // namespace detail

}  // namespace nysalt
