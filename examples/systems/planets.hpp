// SPDX-License-Identifier: BSL-1.0
// The outer solar system: its bodies, the flow of the Kepler problem, and the method of Wisdom and Holman.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "nysalt/core/sentence.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/flows/sum_of_parts.hpp"

// A star with planets in Jacobi's coordinates: Kepler motions, and what the planets do to each other.

namespace examples {

using namespace nysalt;

/// Masses of a star and its planets, with what follows from them for Jacobi's coordinates: r_i from the
/// centre of mass of the star and the planets before i, of the reduced mass m_i M_{i-1}/M_i with M_i = m_0 +
/// ... + m_i.
template <int Planets>
  requires(Planets >= 1)
class jacobi_masses {
 public:
  /// The star's mass first. Throws std::invalid_argument unless all masses and G are positive and finite.
  jacobi_masses(const std::array<double, Planets + 1>& masses, double gravity)
      : masses_(masses), gravity_(gravity) {
    double all = masses[0];
    require_positive("the mass of the star", masses[0]);
    require_positive("the gravitational constant", gravity);
    for (std::size_t i = 0; i < Planets; ++i) {
      require_positive("the mass of a planet", masses[i + 1]);
      attraction_[i] = gravity * (all + masses[i + 1]);
      reduced_[i] = masses[i + 1] * all / (all + masses[i + 1]);
      all += masses[i + 1];
      share_[i] = masses[i + 1] / all;
    }
  }

  double mass(std::size_t body) const { return masses_[body]; }  ///< mass of the star (0) or planet i (i)
  double gravity() const { return gravity_; }                    ///< G
  double reduced_mass(std::size_t planet) const { return reduced_[planet]; }  ///< planets are counted from 0
  /// G M_i: the Kepler motion is r'' = -G M_i r/|r|^3.
  double attraction(std::size_t planet) const { return attraction_[planet]; }
  /// m_i/M_i: how far the centre of mass lies on the way to planet i.
  double share(std::size_t planet) const { return share_[planet]; }

 private:
  static void require_positive(const char* what, double x) {
    if (x > 0.0 && std::isfinite(x)) return;
    throw std::invalid_argument(sentence("solar_system: {} must be positive and finite, got {}", what, x));
  }
  std::array<double, Planets + 1> masses_;
  double gravity_;
  std::array<double, Planets> attraction_{};
  std::array<double, Planets> reduced_{};
  std::array<double, Planets> share_{};
};

/// Part 0 of a solar system: each planet on its ellipse, V = -sum reduced_mass attraction/|r_i|, and K. Its
/// flow, with K, is that of the letter kepler_flow.
template <int Planets>
class kepler_motions {
 public:
  static constexpr int dimension = 3 * Planets;
  static constexpr int lanes = 1;                  // kepler_flow iterates as often as each state needs
  static constexpr std::size_t planets = Planets;  ///< number of planets

  /// The part of a solar system of these masses.
  explicit kepler_motions(const jacobi_masses<Planets>& masses) : masses_(masses) {}

  const jacobi_masses<Planets>& masses() const { return masses_; }  ///< masses of the star and its planets
  double inverse_mass(Eigen::Index i) const {
    return 1.0 / masses_.reduced_mass(static_cast<std::size_t>(i / 3));
  }
  template <class T>
  T potential(const vector<T, dimension>& q) const {
    using std::sqrt;
    T sum(0.0);
    for (std::size_t k = 0; k < planets; ++k) {
      const auto at = static_cast<Eigen::Index>(3 * k);
      const T square = q[at] * q[at] + q[at + 1] * q[at + 1] + q[at + 2] * q[at + 2];
      sum += T(-masses_.reduced_mass(k) * masses_.attraction(k)) / sqrt(square);
    }
    return sum;
  }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    using std::sqrt;
    for (std::size_t k = 0; k < planets; ++k) {
      const auto at = static_cast<Eigen::Index>(3 * k);
      const T square = q[at] * q[at] + q[at + 1] * q[at + 1] + q[at + 2] * q[at + 2];
      const T pull = T(-masses_.reduced_mass(k) * masses_.attraction(k)) / (square * sqrt(square));
      for (Eigen::Index i = at; i < at + 3; ++i) f[i] = q[i] * pull;
    }
  }
  std::string description() const { return masses_text("kepler_motions"); }
  /// A name with all masses and G.
  std::string masses_text(const char* name) const {
    std::string all = sentence("{}(G={}; masses", name, masses_.gravity());
    for (std::size_t k = 0; k <= planets; ++k) all += sentence(" {}", masses_.mass(k));
    return all + ")";
  }

 private:
  jacobi_masses<Planets> masses_;
};

/// Part 1: the whole gravity of star and planets less that of kepler_motions, smaller by the ratio of masses.
template <int Planets>
class planet_interaction {
 public:
  static constexpr int dimension = 3 * Planets;
  static constexpr int lanes = 1;  ///< 1: trajectories are stepped one at a time

  /// The part of a solar system of these masses.
  explicit planet_interaction(const jacobi_masses<Planets>& masses) : kepler_(masses) {}

  template <class T>
  T potential(const vector<T, dimension>& q) const {
    using std::sqrt;
    const auto& m = kepler_.masses();
    const auto x = from_star(q);
    T sum = -kepler_.potential(q);
    for (std::size_t i = 0; i < Planets; ++i) {
      sum -= T(m.gravity() * m.mass(0) * m.mass(i + 1)) / sqrt(square_of(x, i));
      for (std::size_t j = 0; j < i; ++j) {
        sum -= T(m.gravity() * m.mass(j + 1) * m.mass(i + 1)) / sqrt(square_between(x, i, j));
      }
    }
    return sum;
  }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    using std::sqrt;
    const auto& m = kepler_.masses();
    const auto x = from_star(q);
    vector<T, dimension> of_star = x;  // forces by the coordinates from the star
    for (std::size_t i = 0; i < Planets; ++i) {
      const T square = square_of(x, i);
      const T pull = T(-m.gravity() * m.mass(0) * m.mass(i + 1)) / (square * sqrt(square));
      for (Eigen::Index c = 0; c < 3; ++c) of_star[at(i) + c] = x[at(i) + c] * pull;
    }
    for (std::size_t i = 0; i < Planets; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const T square = square_between(x, i, j);
        const T pull = T(-m.gravity() * m.mass(j + 1) * m.mass(i + 1)) / (square * sqrt(square));
        for (Eigen::Index c = 0; c < 3; ++c) {
          const T between = (x[at(i) + c] - x[at(j) + c]) * pull;
          of_star[at(i) + c] += between;
          of_star[at(j) + c] -= between;
        }
      }
    }
    kepler_.force(q, f);
    for (Eigen::Index c = 0; c < 3; ++c) {
      T beyond(0.0);
      for (std::size_t i = Planets; i-- > 0;) {
        f[at(i) + c] = of_star[at(i) + c] + beyond * m.share(i) - f[at(i) + c];
        beyond += of_star[at(i) + c];
      }
    }
  }
  std::string description() const { return kepler_.masses_text("planet_interaction"); }

 private:
  static Eigen::Index at(std::size_t planet) { return static_cast<Eigen::Index>(3 * planet); }
  template <class T>
  static T square_of(const vector<T, dimension>& x, std::size_t i) {
    return x[at(i)] * x[at(i)] + x[at(i) + 1] * x[at(i) + 1] + x[at(i) + 2] * x[at(i) + 2];
  }
  template <class T>
  static T square_between(const vector<T, dimension>& x, std::size_t i, std::size_t j) {
    T sum(0.0);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const T d = x[at(i) + c] - x[at(j) + c];
      sum += d * d;
    }
    return sum;
  }
  /// Positions from the star: x_i = r_i + sum_{k<i} m_k/M_k r_k.
  template <class T>
  vector<T, dimension> from_star(const vector<T, dimension>& q) const {
    vector<T, dimension> x = q;
    for (Eigen::Index c = 0; c < 3; ++c) {
      T centre(0.0);
      for (std::size_t i = 0; i < Planets; ++i) {
        x[at(i) + c] += centre;
        centre += q[at(i) + c] * kepler_.masses().share(i);
      }
    }
    return x;
  }

  kepler_motions<Planets> kepler_;
};

struct kepler_flow;

/// A star with planets in Jacobi's coordinates, the centre of mass at rest: part 0 kepler_motions, part 1
/// planet_interaction. Source: [wisdom_holman_1991].
template <int Planets>
class solar_system : public sum_of_parts<kepler_motions<Planets>, planet_interaction<Planets>> {
  using base = sum_of_parts<kepler_motions<Planets>, planet_interaction<Planets>>;

 public:
  using letters = std::tuple<kepler_flow, kick_of_part<0>, kick_of_part<1>>;

  /// A solar system from the masses, the star's first, and G. Throws std::invalid_argument unless all are
  /// positive and finite.
  solar_system(const std::array<double, Planets + 1>& masses, double gravity)
      : base(kepler_motions<Planets>(jacobi_masses<Planets>(masses, gravity)),
             planet_interaction<Planets>(jacobi_masses<Planets>(masses, gravity))) {}

  /// Jacobi's coordinates and momenta of positions and velocities from anywhere, body after body, the star
  /// first.
  phase_point<double, 3 * Planets> from_bodies(
      const std::array<double, std::size_t{3} * (Planets + 1)>& positions,
      const std::array<double, std::size_t{3} * (Planets + 1)>& velocities) const {
    const auto& m = this->template part<0>().masses();
    phase_point<double, 3 * Planets> result;
    for (std::size_t c = 0; c < 3; ++c) {
      double centre = positions[c];
      double drift = velocities[c];
      for (std::size_t i = 0; i < Planets; ++i) {
        const auto k = static_cast<Eigen::Index>(3 * i + c);
        result.q[k] = positions[3 * (i + 1) + c] - centre;
        const double velocity = velocities[3 * (i + 1) + c] - drift;
        result.p[k] = velocity * m.reduced_mass(i);
        centre += m.share(i) * result.q[k];
        drift += m.share(i) * velocity;
      }
    }
    return result;
  }
};

/// Sun, Jupiter, Saturn, Uranus, Neptune and Pluto; astronomical units, days, masses of the sun (that of the
/// inner planets added to it). Source: [hairer_lubich_wanner_2006, section I.2.4].
inline solar_system<5> outer_solar_system() {
  return {{1.00000597682, 0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449,
           1.0 / 1.3e8},
          2.95912208286e-4};
}
/// Positions and momenta of sun and outer planets on September 5, 1994, at 0h00. Source:
/// [hairer_lubich_wanner_2006, table I.2.2].
inline phase_point<double, 15> outer_solar_system_start() {
  return outer_solar_system().from_bodies(
      {0.0, 0.0, 0.0, -3.5023653, -3.8169847, -1.5507963, 9.0755314, -3.0458353, -1.6483708, 8.3101420,
       -16.2901086, -7.2521278, 11.4707666, -25.7294829, -10.8169456, -15.5387357, -25.2225594, -3.1902382},
      {0.0, 0.0, 0.0, 0.00565429, -0.00412490, -0.00190589, 0.00168318, 0.00483525, 0.00192462, 0.00354178,
       0.00137102, 0.00055029, 0.00288930, 0.00114527, 0.00039677, 0.00276725, -0.00170702, -0.00136504});
}

namespace orbits {

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

}  // namespace orbits

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
      orbits::move_on_orbit(part.masses().attraction(k), t, q, v);
      for (std::size_t c = 0; c < 3; ++c) {
        x.q[at + static_cast<Eigen::Index>(c)] = q[c];
        x.p[at + static_cast<Eigen::Index>(c)] = v[c] * mass;
      }
    }
  }
};

/// Half a kick by the other planets, all planets along their ellipses, half a kick: order 2, symmetric, with
/// an error of the size of the masses of the planets times h^2. One evaluation of the interaction and one
/// Kepler motion of each planet a step, of a solar_system. Source: [wisdom_holman_1991].
inline method wisdom_holman() {
  return {"wisdom_holman",
          word_of<kick_of_part<1>, kepler_flow, kick_of_part<1>>(),
          {0.5, 1.0, 0.5},
          {2, true, false}};
}

/// The words of Kepler motions and kicks by the other planets in turn that read the same from both ends, with
/// `Kicks` kicks, to learn: Kepler motions first.
template <int Kicks>
  requires(Kicks >= 2 && Kicks < 10)
struct planetary : symmetric_composition<kepler_flow, kick_of_part<1>, 2 * Kicks + 1> {
 private:
  static constexpr nysalt::detail::numbered_name<11> text{"planetary_", Kicks};

 public:
  static constexpr std::string_view name{text.text.data(), text.text.size()};
};

}  // namespace examples
