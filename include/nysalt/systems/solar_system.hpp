// SPDX-License-Identifier: BSL-1.0
// A star with planets in Jacobi's coordinates: Kepler motions, and what the planets do to each other.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/systems/sum_of_parts.hpp"

namespace nysalt {

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

/// A star with planets in Jacobi's coordinates, the centre of mass at rest: part 0 kepler_motions, part 1
/// planet_interaction. Source: [wisdom_holman_1991].
template <int Planets>
class solar_system : public sum_of_parts<kepler_motions<Planets>, planet_interaction<Planets>> {
  using base = sum_of_parts<kepler_motions<Planets>, planet_interaction<Planets>>;

 public:
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

}  // namespace nysalt
