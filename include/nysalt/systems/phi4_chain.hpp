// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/detail/sentence.hpp"
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
  bool has_modes() const { return size() <= most_for_full_basis; }
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
  /// that of the springs at most 4.
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

}  // namespace nysalt
