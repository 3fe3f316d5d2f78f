// SPDX-License-Identifier: BSL-1.0
// The phi^4 model on a chain and on a lattice.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/core/independent_iterations.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/local_system.hpp"

namespace nysalt {

/// The phi^4 chain: unit masses, each in a quartic well and joined to the next by a linear spring, the last
/// to the first (periodic ends) [aoki_kusnezov_2002]:
///   H = sum_i p_i^2/2 + (q_{i+1} - q_i)^2/2 + q_i^4/4,  q_{n+1} = q_1.
/// Masses is n, or Eigen::Dynamic. A force costs one pass of 2 n multiplications and 3 n additions.
template <int Masses = Eigen::Dynamic>
class phi4_chain {
 public:
  static constexpr int dimension = Masses;

  phi4_chain()
    requires(Masses != Eigen::Dynamic)
      : phi4_chain(Masses) {}

  /// Throws std::invalid_argument unless masses >= 1 (and fits Masses).
  explicit phi4_chain(Eigen::Index masses) : masses_(masses) {
    if (masses >= 1 && (Masses == Eigen::Dynamic || masses == Masses)) return;
    throw std::invalid_argument(sentence("phi4_chain: masses must be >= 1 and fit the type, got {}", masses));
  }

  Eigen::Index size() const { return Masses == Eigen::Dynamic ? masses_ : Masses; }

  template <class T>
  T potential(const vector<T, dimension>& q) const {
    T springs(0.0);
    T wells(0.0);
    for (Eigen::Index i = 0; i < size(); ++i) {
      const T elongation = q[next(i)] - q[i];
      const T square = q[i] * q[i];
      springs += elongation * elongation;
      wells += square * square;
    }
    return springs * 0.5 + wells * 0.25;
  }

  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    T left = q[0] - q[size() - 1];
    for (Eigen::Index i = 0; i < size(); ++i) {
      const T right = q[next(i)] - q[i];
      f[i] = right - left - q[i] * q[i] * q[i];
      left = right;
    }
  }

  // A LocalSystem, a site being a mass.
  static constexpr int components = 1;                  ///< coordinates of a site
  Eigen::Index sites() const { return size(); }         ///< n
  static constexpr Eigen::Index reach() { return 1; }   ///< sites between a force and what the force reads
  static constexpr bool is_periodic() { return true; }  ///< the last mass is joined to the first
  /// The force on masses begin .. end - 1.
  template <class T>
  void force_in_range(const site_columns<const T>& q, const site_columns<T>& f, Eigen::Index begin,
                      Eigen::Index end) const {
    for (Eigen::Index i = begin; i < end; ++i) f(0, i) = force_at(q, i);
  }
  /// p += c force_in_range(q).
  template <class T, class C>
  void kick_in_range(const site_columns<const T>& q, const site_columns<T>& p, const C& c, Eigen::Index begin,
                     Eigen::Index end) const {
    for (Eigen::Index i = begin; i < end; ++i) p(0, i) += force_at(q, i) * c;
  }
  /// The energies of wells begin .. end - 1 and of the springs to their right.
  template <class T>
  T potential_in_range(const site_columns<const T>& q, Eigen::Index begin, Eigen::Index end) const {
    T springs(0.0);
    T wells(0.0);
    for (Eigen::Index i = begin; i < end; ++i) {
      const T elongation = q(0, i + 1) - q(0, i);
      const T square = q(0, i) * q(0, i);
      springs += elongation * elongation;
      wells += square * square;
    }
    return springs * 0.5 + wells * 0.25;
  }

  /// The force of the wells only, -q_i^3.
  template <class T>
  void soft_force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for (Eigen::Index i = 0; i < size(); ++i) f[i] = -(q[i] * q[i] * q[i]);
  }

  /// Modes of the springs: waves of wavenumber k = 0..n/2 and frequency 2 sin(pi k/n), a cosine and a sine of
  /// each but the first and, of an even chain, the last. The first is a shift of all, of frequency zero.
  /// A full basis: has_modes() is false of a chain for which it is too large.
  bool has_modes() const { return size() <= detail::most_for_full_basis; }
  normal_modes modes() const {
    const Eigen::Index n = size();
    normal_modes result{Eigen::MatrixXd(n, n), Eigen::VectorXd(n)};
    for (Eigen::Index column = 0; column < n; ++column) {
      const Eigen::Index k = (column + 1) / 2;
      const bool is_sine = column > 0 && column % 2 == 0;
      const double wavenumber = std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
      const double norm = std::sqrt((k == 0 || 2 * k == n ? 1.0 : 2.0) / static_cast<double>(n));
      for (Eigen::Index i = 0; i < n; ++i) {
        const double phase = 2.0 * wavenumber * static_cast<double>(i);
        result.basis(i, column) = norm * (is_sine ? std::sin(phase) : std::cos(phase));
      }
      result.frequencies[column] = 2.0 * std::sin(wavenumber);
    }
    return result;
  }

  /// Energy of a mass that starts at five deviations of q, 0.5, and of p, 1: p^2/2 + q^4/4.
  static constexpr double usual_well_energy = 0.5 * 5.0 * 5.0 + 0.25 * 2.5 * 2.5 * 2.5 * 2.5;

  /// While each well holds an energy up to `well_energy`: its stiffness is 3 q^2 = 6 sqrt(energy) then, and
  /// the stiffness of the springs at most 4.
  std::vector<frequency_band> frequency_bands(double well_energy = usual_well_energy) const {
    return {{0.0, std::sqrt(4.0 + 6.0 * std::sqrt(well_energy))}};
  }
  /// Frequency bands in a bath: a well holds less than 12.5 kT, the energy of five deviations, but for one in
  /// 10^5.
  std::vector<frequency_band> frequency_bands_at(double temperature) const {
    return frequency_bands(std::max(usual_well_energy, 12.5 * temperature));
  }
  std::string description() const { return sentence("phi4_chain(masses={})", size()); }
  /// The description without the size.
  std::string kind() const { return "phi4_chain()"; }

 private:
  template <class T>
  [[gnu::always_inline]] static T force_at(const site_columns<const T>& q, Eigen::Index i) {
    const T left = q(0, i) - q(0, i - 1);
    const T right = q(0, i + 1) - q(0, i);
    return right - left - q(0, i) * q(0, i) * q(0, i);
  }
  Eigen::Index next(Eigen::Index i) const { return i + 1 < size() ? i + 1 : 0; }

  Eigen::Index masses_;
};

/// Lattice phi^4 theory on a square of L x L sites with periodic boundaries
/// [albergo_kanwar_shanahan_2019], each site with unit mass:
///   V = sum over sites of m^2 q^2 + lambda q^4 + (q_right - q)^2 + (q_down - q)^2.
/// Site (row, column) is coordinate row L + column. A force costs one pass over the lattice; loops over
/// columns fill the processor's lanes, so that a large lattice is stepped one trajectory at a time.
class phi4_lattice {
 public:
  static constexpr int dimension = Eigen::Dynamic;

  /// Side L, squared mass m^2, which may be negative, and coupling lambda. Throws std::invalid_argument
  /// unless L is from 2 to 4096, m^2 is finite and lambda > 0.
  explicit phi4_lattice(Eigen::Index side, double mass_squared = -4.0, double coupling = 4.0)
      : side_(side), mass_squared_(mass_squared), coupling_(coupling) {
    constexpr Eigen::Index most = 4096;
    if (side < 2 || side > most) {
      throw std::invalid_argument(
          sentence("phi4_lattice: the side must be from 2 to {}, got {}", most, side));
    }
    if (!std::isfinite(mass_squared) || !(coupling > 0.0) || !std::isfinite(coupling)) {
      throw std::invalid_argument(
          sentence("phi4_lattice: the squared mass must be finite and the coupling positive, got {} and {}",
                   mass_squared, coupling));
    }
  }

  Eigen::Index size() const { return side_ * side_; }
  Eigen::Index side() const { return side_; }            ///< L
  double mass_squared() const { return mass_squared_; }  ///< m^2
  double coupling() const { return coupling_; }          ///< lambda

  template <class T>
  T potential(const vector<T, dimension>& q) const {
    T sum(0.0);
    for_each_row([&](Eigen::Index row, Eigen::Index, Eigen::Index below) {
      add_potential_of_row(q.data() + row, q.data() + below, sum);
    });
    return sum;
  }

  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    each_force(
        q, [out = f.data()](Eigen::Index i, const T& x) __attribute__((always_inline)) { out[i] = x; });
  }

  /// p += c f(q), in one pass.
  template <class T, class C>
  void kick(const vector<T, dimension>& q, vector<T, dimension>& p, const C& c) const {
    each_force(
        q, [ out = p.data(), c ](Eigen::Index i, const T& x)
               __attribute__((always_inline)) { out[i] += x * c; });
  }

  // A LocalSystem, whose ranges are whole rows of sites.
  static constexpr int components = 1;                  ///< coordinates of a site
  Eigen::Index sites() const { return size(); }         ///< number of sites, L^2
  Eigen::Index reach() const { return side_; }          ///< the rows above and below
  static constexpr bool is_periodic() { return true; }  ///< the last row is next to the first
  Eigen::Index sites_of_row() const { return side_; }   ///< L
  /// The force on the sites of rows begin/L .. end/L - 1.
  template <class T>
  void force_in_range(const site_columns<const T>& q, const site_columns<T>& f, Eigen::Index begin,
                      Eigen::Index end) const {
    for (Eigen::Index row = begin; row < end; row += side_) {
      each_force_of_row(
          &q(0, row), &q(0, row - side_),
          &q(0, row + side_), [out = &f(0, row)](Eigen::Index k, const T& x) __attribute__((always_inline)) {
            out[k] = x;
          });
    }
  }
  /// p += c force_in_range(q).
  template <class T, class C>
  void kick_in_range(const site_columns<const T>& q, const site_columns<T>& p, const C& c, Eigen::Index begin,
                     Eigen::Index end) const {
    for (Eigen::Index row = begin; row < end; row += side_) {
      each_force_of_row(
          &q(0, row), &q(0, row - side_), &q(0, row + side_),
          [ out = &p(0, row), c ](Eigen::Index k, const T& x)
              __attribute__((always_inline)) { out[k] += x * c; });
    }
  }
  /// Potential energy of the sites of these rows, with the springs to the right and down.
  template <class T>
  T potential_in_range(const site_columns<const T>& q, Eigen::Index begin, Eigen::Index end) const {
    T sum(0.0);
    for (Eigen::Index row = begin; row < end; row += side_) {
      add_potential_of_row(&q(0, row), &q(0, row + side_), sum);
    }
    return sum;
  }

  std::string description() const {
    return sentence("phi4_lattice(side={}, mass_squared={}, coupling={})", side_, mass_squared_, coupling_);
  }
  /// The description without the side.
  std::string kind() const {
    return sentence("phi4_lattice(mass_squared={}, coupling={})", mass_squared_, coupling_);
  }

 private:
  /// body(row, above, below) with the first coordinates of these rows.
  [[gnu::always_inline]] void for_each_row(const auto& body) const {
    for (Eigen::Index r = 0; r < side_; ++r) {
      body(r * side_, (r > 0 ? r - 1 : side_ - 1) * side_, (r + 1 < side_ ? r + 1 : 0) * side_);
    }
  }

  /// Adds the terms of V of a row, with the springs to the right and to the row below.
  template <class T>
  void add_potential_of_row(const T* here, const T* below, T& sum) const {
    for (Eigen::Index k = 0; k < side_; ++k) {
      const T& x = here[k];
      const T right = here[k + 1 < side_ ? k + 1 : 0] - x;
      const T down = below[k] - x;
      const T square = x * x;
      sum += square * (square * coupling_ + mass_squared_) + right * right + down * down;
    }
  }

  /// take(i, f_i) for all sites.
  template <class T>
  [[gnu::always_inline]] void each_force(const vector<T, dimension>& q, const auto& take) const {
    for_each_row([&](Eigen::Index row, Eigen::Index above, Eigen::Index below)
                     __attribute__((always_inline)) {
                       each_force_of_row(
                           q.data() + row, q.data() + above,
                           q.data() + below, [&](Eigen::Index k, const T& x) __attribute__((always_inline)) {
                             take(row + k, x);
                           });
                     });
  }

  /// take(k, f) for the columns k of a row:
  /// -dV/dq = 2 (the sum of the four neighbours) - (2 m^2 + 8) q - 4 lambda q^3.
  template <class T>
  [[gnu::always_inline]] void each_force_of_row(const T* here, const T* up, const T* down,
                                                const auto& take) const {
    const double linear = 2.0 * mass_squared_ + 8.0;
    const double cubic = 4.0 * coupling_;
    const Eigen::Index last = side_ - 1;
    const auto one = [&](Eigen::Index k, const T& left, const T& right) __attribute__((always_inline)) {
      const T x = here[k];
      const T neighbours = (left + right) + (up[k] + down[k]);
      take(k, neighbours * 2.0 - x * (x * x * cubic + linear));
    };
    one(0, here[last], here[1 < side_ ? 1 : 0]);
    const T* left = detail::as_another_array(here - 1);
    const T* right = detail::as_another_array(here + 1);
    detail::for_independent<T>(
        1, last, [&](Eigen::Index k) __attribute__((always_inline)) { one(k, left[k], right[k]); });
    one(last, here[last - 1], here[0]);
  }

  Eigen::Index side_;
  double mass_squared_;
  double coupling_;
};

}  // namespace nysalt
