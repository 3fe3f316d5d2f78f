// SPDX-License-Identifier: BSL-1.0
// Local systems of all kinds, small: open and periodic, of one component and more, with rows, masses and a
// far reach.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"
#include "nysalt/local_system.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/phi4.hpp"

namespace nysalt::test {

/// Points in a plane in a row, open at both ends: each is drawn to the three before and after it, by springs
/// that harden, and has a mass that depends on its number. It has no kick in ranges and no potential in
/// ranges.
class far_springs {
 public:
  static constexpr int dimension = Eigen::Dynamic;
  static constexpr int components = 2;

  explicit far_springs(Eigen::Index points) : points_(points) {}

  Eigen::Index size() const { return components * points_; }
  double inverse_mass(Eigen::Index i) const { return 1.0 / (1.0 + 0.25 * static_cast<double>(i % 5)); }

  Eigen::Index sites() const { return points_; }
  static constexpr Eigen::Index reach() { return 3; }
  static constexpr bool is_periodic() { return false; }

  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for (Eigen::Index i = 0; i < points_; ++i) {
      for (Eigen::Index c = 0; c < components; ++c) {
        f[components * i + c] = pull<T>([&](Eigen::Index j) { return q[components * j + c]; }, i);
      }
    }
  }
  template <class T>
  void force_in_range(const site_columns<const T>& q, const site_columns<T>& f, Eigen::Index begin,
                      Eigen::Index end) const {
    for (Eigen::Index i = begin; i < end; ++i) {
      for (Eigen::Index c = 0; c < components; ++c) {
        f(c, i) = pull<T>([&](Eigen::Index j) { return q(c, j); }, i);
      }
    }
  }

 private:
  template <class T>
  T pull(const auto& value, Eigen::Index i) const {
    T sum(0.0);
    for (Eigen::Index j = std::max<Eigen::Index>(i - reach(), 0); j <= std::min(i + reach(), points_ - 1);
         ++j) {
      const T way = value(j) - value(i);
      sum += way + way * way * way;
    }
    return sum;
  }

  Eigen::Index points_;
};

/// The same with a reach that leaves out the farthest neighbour on either side: halos are too narrow.
struct short_sighted : far_springs {
  using far_springs::far_springs;
  static constexpr Eigen::Index reach() { return 2; }
};

/// Forgets the bond to the left of each range.
struct deaf_to_the_left : phi4_chain<> {
  using phi4_chain<>::phi4_chain;
  template <class T>
  void force_in_range(const site_columns<const T>& q, const site_columns<T>& f, Eigen::Index begin,
                      Eigen::Index end) const {
    phi4_chain<>::force_in_range(q, f, begin, end);
    if (begin < end) f(0, begin) += q(0, begin) - q(0, begin - 1);
  }
};

/// Symplectic Euler, of order 1: its two letters do not merge.
inline method euler(const std::string& letters) {
  return method("symplectic Euler " + letters, word(letters), {1.0, 1.0}, {1, false, false});
}

/// Drifts and kicks in turn, which begin with either, merge or not, and keep their last force or not.
inline std::vector<method> words_in_turn() {
  return {
      verlet(), verlet_aba(), euler("AB"), euler("BA"), srkn6b(), srkn11b(), member(nystrom(), {0.5, 0.4})};
}

/// visit(system) for each kind, with about that many sites.
void for_each_local_system(const auto& visit, Eigen::Index sites = 12) {
  visit(fpu_chain<>(1, 50.0));
  visit(fpu_chain<>(sites, 50.0));
  visit(phi4_chain<>(sites + 1));
  const auto side =
      std::max<Eigen::Index>(static_cast<Eigen::Index>(std::sqrt(static_cast<double>(sites))), 3);
  visit(phi4_lattice(side, -1.0, 2.0));
  visit(far_springs(sites + 5));
}

/// A bound of the sum of the absolute values of the terms of V, at most four a coordinate, for coordinates
/// below 1.
template <class S>
double absolute_potential(const S& system, const Eigen::VectorXd& q) {
  double stiffest = 8.0;
  if constexpr (requires { system.omega(); }) stiffest += system.omega() * system.omega();
  if constexpr (requires { system.coupling(); })
    stiffest += system.coupling() + std::abs(system.mass_squared());
  return stiffest * (q.squaredNorm() + 1.0);
}

}  // namespace nysalt::test
