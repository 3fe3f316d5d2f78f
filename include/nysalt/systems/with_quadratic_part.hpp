// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>
#include <utility>

#include "nysalt/core/sentence.hpp"
#include "nysalt/force.hpp"
#include "nysalt/systems/modal_coordinates.hpp"

namespace nysalt {

/// A system with a quadratic part q K q/2 split off its potential, for methods that rotate: K may be the
/// Hessian at a minimum, or its stiff part. Decomposed once; all else is the system's own.
template <NystromSystem S>
  requires(!std::is_final_v<S>)
class with_quadratic_part : public S {
 public:
  /// K is `stiffness`, N x N. Throws std::invalid_argument unless K is square, of the system's size, finite,
  /// symmetric, and no eigenvalue is negative.
  with_quadratic_part(S system, Eigen::MatrixXd stiffness)
      : S(std::move(system)), stiffness_(std::move(stiffness)) {
    Eigen::VectorXd inverse_masses = Eigen::VectorXd::Ones(nysalt::size(base()));
    if constexpr (HasInverseMass<S>) {
      for (Eigen::Index i = 0; i < inverse_masses.size(); ++i) inverse_masses[i] = S::inverse_mass(i);
    }
    modes_ = detail::stiffness_modes(stiffness_, inverse_masses, "with_quadratic_part");
  }

  const S& base() const { return *this; }  ///< system as given
  normal_modes modes() const { return modes_; }
  bool has_modes() const { return true; }  ///< true, for every S

  /// The rest of the force, f + K q. Cost: a force and N^2 products.
  template <class T>
    requires SystemOver<S, T>
  void soft_force(const vector<T, S::dimension>& q, vector<T, S::dimension>& f) const {
    nysalt::force<T>(base(), q, f);
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        if (stiffness_(i, j) != 0.0) f[i] += q[j] * stiffness_(i, j);
      }
    }
  }

  std::string description() const {
    return sentence("{} with a quadratic part of frequencies up to {}", describe(base()),
                    modes_.frequencies.maxCoeff());
  }
  /// Kind: the description, as a quadratic part belongs to one size.
  std::string kind() const { return description(); }

 private:
  Eigen::MatrixXd stiffness_;
  normal_modes modes_;
};

}  // namespace nysalt
