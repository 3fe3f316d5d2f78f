// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/systems/fpu_chain.hpp"

namespace nysalt {

/// fpu_chain for one long trajectory of many masses, which are stored in another order: first those at the
/// left ends of the m stiff springs, then those at the right ends. Neighbours in memory then do the same at
/// the same time, which vectorises. Each mass moves as in fpu_chain, to the bit. There is no modes(): their
/// basis would have 4 m^2 entries.
class long_fpu_chain {
 public:
  static constexpr int dimension = Eigen::Dynamic;

  /// `pairs` stiff springs of frequency omega. Throws std::invalid_argument unless pairs >= 1, omega positive
  /// and finite.
  long_fpu_chain(Eigen::Index pairs, double omega) : in_turn_(pairs, omega) {}

  Eigen::Index pairs() const { return in_turn_.pairs(); }  ///< m, stiff springs
  Eigen::Index size() const { return in_turn_.size(); }
  double omega() const { return in_turn_.omega(); }  ///< of the stiff springs

  /// Positions or momenta from the order of fpu_chain, mass after mass, to that of this chain. Throws
  /// std::invalid_argument if there are not 2 m of them.
  template <class T>
  vector<T, dimension> ends_apart(const vector<T, dimension>& in_turn) const {
    require_size(in_turn.size());
    vector<T, dimension> apart(size());
    for (Eigen::Index i = 0; i < pairs(); ++i) {
      apart[i] = in_turn[2 * i];
      apart[pairs() + i] = in_turn[2 * i + 1];
    }
    return apart;
  }
  /// From the order of this chain to that of fpu_chain. Throws likewise.
  template <class T>
  vector<T, dimension> ends_in_turn(const vector<T, dimension>& apart) const {
    require_size(apart.size());
    vector<T, dimension> in_turn(size());
    for (Eigen::Index i = 0; i < pairs(); ++i) {
      in_turn[2 * i] = apart[i];
      in_turn[2 * i + 1] = apart[pairs() + i];
    }
    return in_turn;
  }

  /// V(q). Cost: that of fpu_chain, and a copy of q.
  template <class T>
  T potential(const vector<T, dimension>& q) const {
    return in_turn_.potential(ends_in_turn(q));
  }

  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for_each_spring(
        q, [&](Eigen::Index i, const T& stiff, const T& left, const T& right) __attribute__((always_inline)) {
          f[i] = stiff - left;
          f[pairs() + i] = right - stiff;
        });
  }

  /// g = f'(q) v: stiff springs first, then the soft ones between them, so that both loops vectorise.
  template <class T>
  void force_derivative(const vector<T, dimension>& q, const vector<T, dimension>& v,
                        vector<T, dimension>& g) const {
    const Eigen::Index m = pairs();
    const double k = 0.5 * omega() * omega();
    for (Eigen::Index i = 0; i < m; ++i) {
      const T stiff = (v[m + i] - v[i]) * k;
      g[i] = stiff;
      g[m + i] = -stiff;
    }
    g[0] -= fpu_chain<>::slope_of_pull(q[0], v[0]);
    g[2 * m - 1] -= fpu_chain<>::slope_of_pull(q[2 * m - 1], v[2 * m - 1]);
    for (Eigen::Index i = 0; i + 1 < m; ++i) {
      const T soft = fpu_chain<>::slope_of_pull(T(q[i + 1] - q[m + i]), T(v[i + 1] - v[m + i]));
      g[i + 1] -= soft;
      g[m + i] += soft;
    }
  }

  /// p += c force(q)
  template <class T, class C>
  void kick(const vector<T, dimension>& q, vector<T, dimension>& p, const C& c) const {
    for_each_spring(
        q, [&](Eigen::Index i, const T& stiff, const T& left, const T& right) __attribute__((always_inline)) {
          p[i] += (stiff - left) * c;
          p[pairs() + i] += (right - stiff) * c;
        });
  }

  /// As of fpu_chain: the energy of stiff spring j = 0..m-1, and their sum.
  template <class T>
  T stiff_energy(const phase_point<T, dimension>& x, Eigen::Index j) const {
    const T stretch = x.q[pairs() + j] - x.q[j];
    const T rate = x.p[pairs() + j] - x.p[j];
    return (rate * rate + stretch * stretch * (omega() * omega())) * 0.25;
  }
  template <class T>
  T stiff_energy(const phase_point<T, dimension>& x) const {
    T sum(0.0);
    for (Eigen::Index j = 0; j < pairs(); ++j) sum += stiff_energy(x, j);
    return sum;
  }

  std::vector<frequency_band> frequency_bands(double soft_energy = 2.0) const {
    return in_turn_.frequency_bands(soft_energy);
  }
  /// As fpu_chain.
  std::vector<frequency_band> frequency_bands_at(double temperature) const {
    return in_turn_.frequency_bands_at(temperature);
  }
  std::string description() const { return sentence("long_fpu_chain(pairs={}, omega={})", pairs(), omega()); }
  /// That of fpu_chain, whose motion it has.
  std::string kind() const { return in_turn_.kind(); }

 private:
  /// use(i, stiff, left, right) for stiff springs i = 0..m-1: its own pull and those of the soft ones on
  /// either side. Blocks of soft pulls go first: no turn of a loop waits for the one before, and no cube is
  /// taken twice.
  template <class T>
  void for_each_spring(const vector<T, dimension>& q, const auto& use) const {
    constexpr Eigen::Index block = 64;
    const Eigen::Index m = pairs();
    const double k = 0.5 * omega() * omega();
    T soft[block + 1];
    for (Eigen::Index first = 0; first < m; first += block) {
      const Eigen::Index end = std::min(first + block, m);
      const Eigen::Index inner_end = std::min(end, m - 1);
      soft[0] = first == 0 ? fpu_chain<>::quartic_pull(q[0])
                           : fpu_chain<>::quartic_pull(T(q[first] - q[m + first - 1]));
      for (Eigen::Index i = first; i < inner_end; ++i) {
        soft[i - first + 1] = fpu_chain<>::quartic_pull(T(q[i + 1] - q[m + i]));
      }
      if (end == m) soft[m - first] = fpu_chain<>::quartic_pull(T(-q[2 * m - 1]));
      for (Eigen::Index i = first; i < end; ++i) {
        use(i, T((q[m + i] - q[i]) * k), soft[i - first], soft[i - first + 1]);
      }
    }
  }

  void require_size(Eigen::Index n) const {
    if (n == size()) return;
    throw std::invalid_argument(sentence("long_fpu_chain: {} masses have no {} coordinates", size(), n));
  }

  fpu_chain<> in_turn_;
};

}  // namespace nysalt
