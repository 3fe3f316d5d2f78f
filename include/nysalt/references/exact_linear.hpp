// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "nysalt/bath.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/force.hpp"

namespace nysalt {

/// The exact flow of a linear system, mode by mode: x(t) = cos(w t) x + sin(w t)/w y,
/// y(t) = -w sin(w t) x + cos(w t) y with x = U^T M^{1/2} q, y = U^T M^{-1/2} p. The error is rounding. An
/// object belongs to one linear system and refuses any other, where the error would not be noticed.
class exact_linear {
 public:
  // Not of itself, first of all: whether that is a system depends on whether it can be copied.
  /// Throws std::invalid_argument if a bath acts, the modes are not orthonormal or the force is not the
  /// linear one that they describe. Cost: 9 forces.
  template <class S>
    requires(!std::same_as<S, exact_linear> && NystromSystem<S> && HasModes<S>)
  explicit exact_linear(const S& system) : system_(describe(system)) {
    if constexpr (HasBath<S>) require_no_bath(system);
    require_orthonormal(system.modes(), size(system));
    modes_ = modal_coordinates::of(system);
    require_linear(system);
  }

  /// The point becomes the state a time t later. Throws std::invalid_argument if the system's description is
  /// not that of the constructor's. Cost: four products for each entry of the basis that is not zero.
  template <System S>
  void advance(const S& system, phase_point<double, S::dimension>& point, double t) const {
    if (const std::string other = describe(system); other != system_) {
      throw std::invalid_argument(
          sentence("exact_linear: the system must be that of the constructor, {}, got {}; make an "
                   "exact_linear of this system",
                   system_, other));
    }
    Eigen::VectorXd x(modes_->size());
    Eigen::VectorXd y(modes_->size());
    modes_->to_modes(point.q, point.p, x, y);
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      const double w = modes_->frequencies()[static_cast<std::size_t>(k)];
      const double c = std::cos(w * t);
      const double s = std::sin(w * t);
      const double x_new = c * x[k] + (w == 0.0 ? t : s / w) * y[k];
      y[k] = -w * s * x[k] + c * y[k];
      x[k] = x_new;
    }
    modes_->from_modes(x, y, point.q, point.p);
  }

  exact_linear finer() const { return *this; }                         ///< the same object: the flow is exact
  std::string description() const { return "the exact linear flow"; }  ///< description for provenance

 private:
  static constexpr double eps = std::numeric_limits<double>::epsilon();

  void require_no_bath(const auto& system) const {
    const bath& heat_bath = system.bath();
    if (!heat_bath.acts()) return;
    throw std::invalid_argument(sentence("exact_linear: the system must be in no bath, got {}", system_));
  }
  void require_orthonormal(const normal_modes& modes, Eigen::Index n) const;

  /// Compares the force with -M^{1/2} U w^2 U^T M^{1/2} q at points in general position, of sizes so
  /// different that a term that is not linear cannot be small at all of them.
  template <System S>
  void require_linear(const S& system) const {
    const Eigen::Map<const Eigen::VectorXd> omega(modes_->frequencies().data(), modes_->size());
    const Eigen::VectorXd squares = omega.cwiseAbs2();
    Eigen::VectorXd root_mass = Eigen::VectorXd::Ones(modes_->size());
    if constexpr (HasInverseMass<S>) {
      for (Eigen::Index i = 0; i < size(system); ++i) root_mass[i] = 1.0 / std::sqrt(system.inverse_mass(i));
    }
    auto q = make_vector<double>(system);
    auto f = q;
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(modes_->size());
    Eigen::VectorXd x(modes_->size());
    Eigen::VectorXd y(modes_->size());
    Eigen::VectorXd back(modes_->size());
    Eigen::VectorXd expected(modes_->size());
    for (const double length : {1e-2, 1.0, 1e2}) {
      for (int point = 0; point < 3; ++point) {
        for (Eigen::Index i = 0; i < q.size(); ++i) {
          q[i] = length * std::sin(1.0 + 2.0 * point + 1.7 * static_cast<double>(i));
        }
        force<double>(system, q, f);
        modes_->to_modes(q, rest, x, y);
        y = -squares.cwiseProduct(x);
        modes_->from_modes(x, y, back, expected);
        // Both sides sum n terms, together below w^2 |M^{1/2} q|_1, and the modes err by some n eps.
        const double rounding = 32.0 * static_cast<double>(q.size()) * eps * squares.maxCoeff() *
                                root_mass.cwiseProduct(q).template lpNorm<1>();
        for (Eigen::Index i = 0; i < q.size(); ++i) {
          if (std::abs(f[i] - expected[i]) <= rounding * root_mass[i]) continue;  // also refuses NaN
          refuse_force(i, f[i], expected[i], length);
        }
      }
    }
  }

  /// Refuses the force on coordinate i, at a state of size `length`.
  [[noreturn]] void refuse_force(Eigen::Index i, double force, double expected, double length) const;

  std::string system_;
  std::shared_ptr<const modal_coordinates> modes_;
};

}  // namespace nysalt
