// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "nysalt/flows/exact_flow.hpp"

namespace nysalt {

namespace detail {

/// G_k(s) = s^k c_k(beta s^2), k = 0..3, with Stumpff's c_k(x) = sum_j (-x)^j/(2 j + k)!. By their series at
/// a quarter of x, again and again, and doubling: x below 0.1 leaves 7 terms above rounding.
template <class T>
std::array<T, 4> stumpff_g(const T& beta, const T& s) {
  T x = beta * s * s;
  int halvings = 0;
  const auto is_large = [](const T& y) { return y > T(0.1) || y < T(-0.1); };
  for (; is_large(x) && halvings < 64; ++halvings) x = x * 0.25;
  T c2(0.0);
  T c3(0.0);
  for (int j = 7; j >= 0; --j) {
    c2 = T(1.0) - x * c2 * (1.0 / ((2.0 * j + 3.0) * (2.0 * j + 4.0)));
    c3 = T(1.0) - x * c3 * (1.0 / ((2.0 * j + 4.0) * (2.0 * j + 5.0)));
  }
  c2 = c2 * 0.5;
  c3 = c3 * (1.0 / 6.0);
  T c1 = T(1.0) - x * c3;
  T c0 = T(1.0) - x * c2;
  for (; halvings > 0; --halvings) {
    c3 = (c2 + c0 * c3) * 0.25;
    c2 = c1 * c1 * 0.5;
    c1 = c0 * c1;
    c0 = c0 * c0 * 2.0 - T(1.0);
  }
  return {c0, s * c1, s * s * c2, s * s * s * c3};
}

template <class T>
double value_in(const T& x) {
  if constexpr (requires { x.value; }) {
    return value_in(x.value);
  } else {
    return x;
  }
}

/// The orbit through q with velocity v, as far as its motion in time asks.
template <class T>
struct kepler_orbit {
  T r;     ///< |q|
  T eta;   ///< q v
  T beta;  ///< 2 mu/r - v^2: positive of an ellipse
  T zeta;  ///< mu - beta r

  /// The time after s, less t, where dt = r ds.
  T too_late(const T& s, const std::array<T, 4>& g, const T& t) const {
    return r * s + eta * g[2] + zeta * g[3] - t;
  }
  T distance(const std::array<T, 4>& g) const { return r + eta * g[1] + zeta * g[2]; }
};

/// The s of a time, over double: Laguerre's method of degree 5, which hardly ever fails to converge, from the
/// time over the distance; until a step no longer changes s. NaN where it has not converged after 60 steps.
inline double universal_anomaly(const kepler_orbit<double>& orbit, double t) {
  constexpr double degree = 5.0;
  double s = t / orbit.r;
  double last = 0.0;
  for (int n = 0; n < 60; ++n) {
    const auto g = stumpff_g(orbit.beta, s);
    const double f = orbit.too_late(s, g, t);
    const double slope = orbit.distance(g);
    const double bend = orbit.eta * g[0] + orbit.zeta * g[1];
    const double root =
        std::sqrt(std::abs((degree - 1.0) * ((degree - 1.0) * slope * slope - degree * f * bend)));
    const double change = degree * f / (slope + (slope > 0.0 ? root : -root));
    s -= change;
    // Converged, or rounding lets it go to and fro.
    if (std::abs(change) <= 1e-15 * std::abs(s) || (n > 8 && std::abs(change) >= std::abs(last))) return s;
    last = change;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// q and v of r'' = -mu r/|r|^3 after a time t, in universal variables: ellipses, parabolas and hyperbolas.
/// The anomaly is found over double, and Newton's method twice more over T brings its derivatives. Source:
/// [danby_1988, section 6.9; conway_1986].
template <class T, class C>
void move_on_orbit(double mu, const C& time, std::array<T, 3>& q, std::array<T, 3>& v) {
  using std::sqrt;
  const T t = T(1.0) * time;
  kepler_orbit<T> orbit;
  orbit.r = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
  orbit.eta = q[0] * v[0] + q[1] * v[1] + q[2] * v[2];
  orbit.beta = T(2.0 * mu) / orbit.r - (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  orbit.zeta = T(mu) - orbit.beta * orbit.r;
  const kepler_orbit<double> values{value_in(orbit.r), value_in(orbit.eta), value_in(orbit.beta),
                                    value_in(orbit.zeta)};
  T s(universal_anomaly(values, value_in(t)));
  if constexpr (requires { t.value; }) {
    for (int n = 0; n < 2; ++n) {
      const auto g = stumpff_g(orbit.beta, s);
      s = s - orbit.too_late(s, g, t) / orbit.distance(g);
    }
  }
  const auto g = stumpff_g(orbit.beta, s);
  const T r = orbit.distance(g);
  const T f = T(-mu) * g[2] / orbit.r;  // less 1, which keeps the digits of short steps
  const T f_of_v = t - g[3] * mu;
  const T f_dot = T(-mu) * g[1] / (orbit.r * r);
  const T g_dot = T(-mu) * g[2] / r;  // less 1
  for (std::size_t c = 0; c < 3; ++c) {
    const T q_before = q[c];
    q[c] += q_before * f + v[c] * f_of_v;
    v[c] += q_before * f_dot + v[c] * g_dot;
  }
}

}  // namespace detail

/// K: the exact motion of each planet along an ellipse, parabola or hyperbola around the centre of mass of
/// the bodies inside: the flow of K and kepler_motions, part 0 of a solar_system. One trajectory at a time,
/// as the number of iterations of Kepler's equation depends on the state. Cost: no force; some ten
/// evaluations of four Stumpff functions a planet. Source: [wisdom_holman_1991; danby_1988].
struct kepler_flow : exact_flow<'K'> {
  template <System S, Scalar T>
  static constexpr bool serves = requires(const S& s) { s.template part<0>().masses().attraction(0); };

  template <System S, class State, CoefficientOf<typename State::scalar_type> C>
  static void apply(const S& system, const C& t, State& x, auto&) {
    using T = typename State::scalar_type;
    const auto& part = system.template part<0>();
    for (std::size_t k = 0; k < part.planets; ++k) {
      const double mass = part.masses().reduced_mass(k);
      const auto at = static_cast<Eigen::Index>(3 * k);
      std::array<T, 3> q{x.q[at], x.q[at + 1], x.q[at + 2]};
      std::array<T, 3> v{x.p[at] * (1.0 / mass), x.p[at + 1] * (1.0 / mass), x.p[at + 2] * (1.0 / mass)};
      detail::move_on_orbit(part.masses().attraction(k), t, q, v);
      for (std::size_t c = 0; c < 3; ++c) {
        x.q[at + static_cast<Eigen::Index>(c)] = q[c];
        x.p[at + static_cast<Eigen::Index>(c)] = v[c] * mass;
      }
    }
  }
};

}  // namespace nysalt
