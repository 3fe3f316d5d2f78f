// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/core/independent_iterations.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/local_system.hpp"

namespace nysalt {

/// Fermi-Pasta-Ulam chain of 2 m unit masses, joined by stiff linear and soft quartic springs in turn,
/// both ends fixed [hairer_lubich_wanner_2006, section I.5.1; li_lu_tao_ye_2023, equation (5.1)]:
///   V = omega^2/4 sum_i (q_{2i} - q_{2i-1})^2 + sum_{i=0..m} (q_{2i+1} - q_{2i})^4,  q_0 = q_{2m+1} = 0.
/// Pairs is m, or Eigen::Dynamic. A force costs one pass of some 4 m multiplications and 4 m additions.
template <int Pairs = Eigen::Dynamic>
class fpu_chain {
 public:
  static constexpr int dimension = Pairs == Eigen::Dynamic ? Eigen::Dynamic : 2 * Pairs;

  /// Stiff springs of frequency omega. Throws std::invalid_argument unless omega is positive and finite.
  explicit fpu_chain(double omega)
    requires(Pairs != Eigen::Dynamic)
      : fpu_chain(Pairs, omega) {}

  /// `pairs` stiff springs of frequency omega. Throws std::invalid_argument unless pairs >= 1 (and fits
  /// Pairs), omega positive and finite.
  fpu_chain(Eigen::Index pairs, double omega) : pairs_(pairs), omega_(omega) {
    if (pairs < 1 || (Pairs != Eigen::Dynamic && pairs != Pairs)) {
      throw std::invalid_argument(sentence("fpu_chain: pairs must be >= 1 and fit the type, got {}", pairs));
    }
    if (!(omega > 0.0) || !std::isfinite(omega)) {
      throw std::invalid_argument(sentence("fpu_chain: omega must be positive and finite, got {}", omega));
    }
  }

  Eigen::Index pairs() const { return Pairs == Eigen::Dynamic ? pairs_ : Pairs; }  ///< m, stiff springs
  Eigen::Index size() const { return 2 * pairs(); }
  double omega() const { return omega_; }  ///< frequency of the stiff springs

  template <class T>
  T potential(const vector<T, dimension>& q) const {
    T stiff(0.0);
    T soft(0.0);
    T bond = q[0];
    for (Eigen::Index i = 0; i < pairs(); ++i) {
      const T elongation = q[2 * i + 1] - q[2 * i];
      stiff += elongation * elongation;
      soft += fourth_power(bond);
      bond = i + 1 < pairs() ? q[2 * i + 2] - q[2 * i + 1] : -q[2 * i + 1];
    }
    soft += fourth_power(bond);
    return stiff * (0.25 * omega_ * omega_) + soft;
  }

  /// Force of a soft bond with the elongation u, 4 u^3.
  template <class T>
  static T quartic_pull(const T& u) {
    return u * u * (u * 4.0);  // two products at once
  }

  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    const double k = 0.5 * omega_ * omega_;
    T left = quartic_pull(q[0]);
    for (Eigen::Index i = 0; i < pairs(); ++i) {
      const T stiff = (q[2 * i + 1] - q[2 * i]) * k;
      const T right = quartic_pull(i + 1 < pairs() ? T(q[2 * i + 2] - q[2 * i + 1]) : T(-q[2 * i + 1]));
      f[2 * i] = stiff - left;
      f[2 * i + 1] = right - stiff;
      left = right;
    }
  }

  /// Derivative of quartic_pull(u) in the direction w, 12 u^2 w.
  template <class T>
  static T slope_of_pull(const T& u, const T& w) {
    return u * u * (w * 12.0);
  }

  /// g = f'(q) v
  template <class T>
  void force_derivative(const vector<T, dimension>& q, const vector<T, dimension>& v,
                        vector<T, dimension>& g) const {
    const double k = 0.5 * omega_ * omega_;
    const auto elongation = [&](const vector<T, dimension>& x, Eigen::Index i) {
      return i + 1 < pairs() ? T(x[2 * i + 2] - x[2 * i + 1]) : T(-x[2 * i + 1]);
    };
    T left = slope_of_pull(q[0], v[0]);
    for (Eigen::Index i = 0; i < pairs(); ++i) {
      const T stiff = (v[2 * i + 1] - v[2 * i]) * k;
      const T right = slope_of_pull(elongation(q, i), elongation(v, i));
      g[2 * i] = stiff - left;
      g[2 * i + 1] = right - stiff;
      left = right;
    }
  }

  /// The force of the soft bonds only.
  template <class T>
  void soft_force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    T left = quartic_pull(q[0]);
    for (Eigen::Index i = 0; i < pairs(); ++i) {
      const T right = quartic_pull(i + 1 < pairs() ? T(q[2 * i + 2] - q[2 * i + 1]) : T(-q[2 * i + 1]));
      f[2 * i] = -left;
      f[2 * i + 1] = right;
      left = right;
    }
  }

  /// p += c force(q), with the 4 of the soft bonds multiplied into c: a power of two changes no bit, short of
  /// underflow.
  template <class T, class C>
  void kick(const vector<T, dimension>& q, vector<T, dimension>& p, const C& c) const {
    const double k = 0.5 * omega_ * omega_ * 0.25;
    const C four_c = c * 4.0;
    T left = q[0] * q[0] * q[0];
    for (Eigen::Index i = 0; i < pairs(); ++i) {
      const T stiff = (q[2 * i + 1] - q[2 * i]) * k;
      const T bond = i + 1 < pairs() ? T(q[2 * i + 2] - q[2 * i + 1]) : T(-q[2 * i + 1]);
      const T right = bond * bond * bond;
      p[2 * i] += (stiff - left) * four_c;
      p[2 * i + 1] += (right - stiff) * four_c;
      left = right;
    }
  }

  // A LocalSystem, a site being a stiff spring with the masses at its left and right end.
  static constexpr int components = 2;                   ///< coordinates of a site
  Eigen::Index sites() const { return pairs(); }         ///< m
  static constexpr Eigen::Index reach() { return 1; }    ///< sites between a force and what the force reads
  static constexpr bool is_periodic() { return false; }  ///< false: the ends are fixed
  /// The force on both ends of stiff springs begin .. end - 1, as a LocalSystem has it.
  template <class T>
  void force_in_range(const site_columns<const T>& q, const site_columns<T>& f, Eigen::Index begin,
                      Eigen::Index end) const {
    in_blocks(
        q, begin, end, [](const T& u) { return quartic_pull(u); }, 0.5 * omega_ * omega_,
        [&](Eigen::Index i, const T& stiff, const T& left, const T& right) __attribute__((always_inline)) {
          f(0, i) = stiff - left;
          f(1, i) = right - stiff;
        });
  }
  /// p += c force_in_range(q), with the 4 of the soft bonds in c as in kick().
  template <class T, class C>
  void kick_in_range(const site_columns<const T>& q, const site_columns<T>& p, const C& c, Eigen::Index begin,
                     Eigen::Index end) const {
    const C four_c = c * 4.0;
    in_blocks(
        q, begin, end, [](const T& u) { return u * u * u; }, 0.5 * omega_ * omega_ * 0.25,
        [&](Eigen::Index i, const T& stiff, const T& left, const T& right) __attribute__((always_inline)) {
          p(0, i) += (stiff - left) * four_c;
          p(1, i) += (right - stiff) * four_c;
        });
  }

  /// The energies of stiff springs begin .. end - 1 and of the soft bonds to their left, and of the last
  /// bond.
  template <class T>
  T potential_in_range(const site_columns<const T>& q, Eigen::Index begin, Eigen::Index end) const {
    T stiff(0.0);
    T soft(0.0);
    for (Eigen::Index i = begin; i < end; ++i) {
      const T elongation = q(1, i) - q(0, i);
      stiff += elongation * elongation;
      soft += fourth_power(i > 0 ? T(q(0, i) - q(1, i - 1)) : q(0, i));
    }
    if (end == pairs()) soft += fourth_power(T(-q(1, end - 1)));
    return stiff * (0.25 * omega_ * omega_) + soft;
  }

  /// I_j = (y_{1,j}^2 + omega^2 x_{1,j}^2)/2, the energy of stiff spring j = 0..m-1
  /// [li_lu_tao_ye_2023, equation (5.4)].
  template <class T>
  T stiff_energy(const phase_point<T, dimension>& x, Eigen::Index j) const {
    const T elongation = x.q[2 * j + 1] - x.q[2 * j];
    const T rate = x.p[2 * j + 1] - x.p[2 * j];
    return (rate * rate + elongation * elongation * (omega_ * omega_)) * 0.25;
  }
  /// I = sum_j I_j, an adiabatic invariant.
  template <class T>
  T stiff_energy(const phase_point<T, dimension>& x) const {
    T sum(0.0);
    for (Eigen::Index j = 0; j < pairs(); ++j) sum += stiff_energy(x, j);
    return sum;
  }

  /// The paper's x_0 (first m columns, frequency 0) and x_1 (last m, frequency omega), equations (5.2-3).
  /// Of more than most_for_full_basis masses as entries.
  normal_modes modes() const {
    const double half = std::sqrt(0.5);
    if (size() > detail::most_for_full_basis) return local_modes(half);
    normal_modes result{Eigen::MatrixXd::Zero(size(), size()), Eigen::VectorXd::Zero(size())};
    for (Eigen::Index i = 0; i < pairs(); ++i) {
      result.basis(2 * i, i) = half;
      result.basis(2 * i + 1, i) = half;
      result.basis(2 * i, pairs() + i) = -half;
      result.basis(2 * i + 1, pairs() + i) = half;
      result.frequencies[pairs() + i] = omega_;
    }
    return result;
  }

  /// Soft band and stiff band for soft bonds that hold an energy up to `soft_energy` each. A bond u
  /// has stiffness 12 u^2 = 12 sqrt(energy), and a mode of the linearised soft chain at most twice it.
  std::vector<frequency_band> frequency_bands(double soft_energy = 2.0) const {
    const double soft = std::sqrt(24.0 * std::sqrt(soft_energy));
    return {{0.0, soft}, {omega_, std::sqrt(omega_ * omega_ + soft * soft)}};
  }
  /// Frequency bands in a bath: a bond holds less than 12.5 kT, the energy of five deviations, but for one in
  /// 10^5.
  std::vector<frequency_band> frequency_bands_at(double temperature) const {
    return frequency_bands(std::max(2.0, 12.5 * temperature));
  }
  std::string description() const { return sentence("fpu_chain(pairs={}, omega={})", pairs(), omega_); }
  /// The description without the size.
  std::string kind() const { return sentence("fpu_chain(omega={})", omega_); }

 private:
  /// take(i, stiff, left, right) for stiff springs begin .. end - 1, with the pull of stiff spring i and of
  /// the soft bonds on either side of it. The soft pulls of a block are computed first, so that both loops
  /// vectorise and no pull is computed twice.
  template <class T>
  [[gnu::always_inline]] void in_blocks(const site_columns<const T>& q, Eigen::Index begin, Eigen::Index end,
                                        const auto& pull, double k, const auto& take) const {
    constexpr Eigen::Index block = 64;
    const Eigen::Index last = pairs();
    T soft[block + 1];  // soft[n] is to the left of site first + n
    for (Eigen::Index first = begin; first < end; first += block) {
      const Eigen::Index count = std::min(block, end - first);
      const Eigen::Index inner_begin = first == 0 ? 1 : 0;
      const Eigen::Index inner_end = first + count == last ? count : count + 1;
      if (first == 0) soft[0] = pull(q(0, 0));
      for (Eigen::Index n = inner_begin; n < inner_end; ++n) {
        soft[n] = pull(T(q(0, first + n) - q(1, first + n - 1)));
      }
      if (first + count == last) soft[count] = pull(T(-q(1, last - 1)));
      const T* right = detail::as_another_array(soft + 1);
      detail::for_independent<T>(
          0, count, [&](Eigen::Index n) __attribute__((always_inline)) {
            const Eigen::Index i = first + n;
            take(i, T((q(1, i) - q(0, i)) * k), soft[n], right[n]);
          });
    }
  }

  normal_modes local_modes(double half) const {
    normal_modes result{{}, Eigen::VectorXd::Zero(size())};
    result.frequencies.tail(pairs()).setConstant(omega_);
    for (Eigen::Index i = 0; i < pairs(); ++i) {
      const Eigen::Index stiff = pairs() + i;
      result.entries.insert(
          result.entries.end(),
          {{2 * i, i, half}, {2 * i, stiff, -half}, {2 * i + 1, i, half}, {2 * i + 1, stiff, half}});
    }
    return result;
  }

  template <class T>
  static T fourth_power(const T& u) {
    const T square = u * u;
    return square * square;
  }
  Eigen::Index pairs_;
  double omega_;
};

}  // namespace nysalt
