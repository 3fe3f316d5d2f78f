// SPDX-License-Identifier: BSL-1.0
// What a check of a force asks of a system, whose type is left behind: the check is compiled once.
#pragma once

#include <memory>
#include <vector>

#include "nysalt/derivatives/differences.hpp"
#include "nysalt/derivatives/force_check.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/quadratic_part.hpp"

namespace nysalt {

/// A potential from which all else comes by automatic differentiation can contradict nothing.
template <class S>
inline constexpr bool force_may_be_wrong = HasForce<S, double> || detail::CanKick<S, double, double> ||
                                           HasForceDerivative<S> || HasSoftForce<S> || HasVelocity<S, double>;

namespace detail {

class force_source {
 public:
  using column = Eigen::VectorXd;

  // Which of the functions below there are, and whether slopes are automatic derivatives.
  Eigen::Index size = 0;
  bool has_potential = false;
  bool has_kick = false;
  bool has_soft_force = false;
  bool has_derivative = false;
  bool has_velocity = false;
  bool has_kinetic_energy = false;
  bool has_exact_potential = false;
  bool has_exact_force = false;
  bool has_exact_velocity = false;

  virtual ~force_source() = default;
  virtual void force(const column& q, column& f) const = 0;
  /// Of the force along v, which is as long as a displacement of the motion, as all directions are.
  virtual void force_slope(const column& q, const column& v, column& g) const = 0;
  virtual double potential_slope(const column& q, const column& v) const = 0;
  /// p += force(q)/2
  virtual void kick(const column& q, column& p) const = 0;
  virtual void soft_force(const column& q, column& f) const = 0;
  virtual std::shared_ptr<const quadratic_part> quadratic() const = 0;
  virtual void derivative(const column& q, const column& v, column& g) const = 0;
  virtual void velocity(const column& p, column& v) const = 0;
  virtual void velocity_slope(const column& p, const column& v, column& g) const = 0;
  virtual double kinetic_slope(const column& p, const column& v) const = 0;
};

template <SeparableSystem S>
class force_source_of final : public force_source {
  static constexpr int N = S::dimension;
  using own = vector<double, N>;
  using D = dual<double, 1>;
  static constexpr bool exact_potential = HasPotential<S, D>;
  static constexpr bool exact_kinetic = HasKineticEnergy<S, D>;
  static constexpr bool exact_velocity = HasVelocity<S, D>;

 public:
  explicit force_source_of(const S& system) : system_(system) {
    size = nysalt::size(system);
    has_potential = HasPotential<S, double>;
    has_kick = HasKick<S, double>;
    has_soft_force = HasQuadraticPart<S>;
    has_derivative = HasForceDerivative<S>;
    has_velocity = HasVelocity<S, double>;
    has_kinetic_energy = HasKineticEnergy<S, double>;
    has_exact_potential = exact_potential && !BlackBoxForce<S>;
    has_exact_force = !BlackBoxForce<S>;
    has_exact_velocity = has_kinetic_energy ? exact_kinetic : exact_velocity;
  }

  void force(const column& q, column& f) const override {
    own result(q.size());
    nysalt::force<double>(system_, own(q), result);
    f = result;
  }
  void force_slope(const column& q, const column& v, column& g) const override {
    vector<D, N> result(q.size());
    nysalt::force<D>(system_, lifted(q, v), result);
    for (Eigen::Index i = 0; i < q.size(); ++i) g[i] = result[i].derivative[0];
  }
  double potential_slope(const column& q, const column& v) const override {
    if constexpr (exact_potential) {
      return system_.potential(lifted(q, v)).derivative[0];
    } else if constexpr (HasPotential<S, double>) {
      return difference_along([&](const column& x) { return system_.potential(own(x)); }, q, v);
    }
    return 0.0;
  }
  void kick(const column& q, column& p) const override {
    if constexpr (HasKick<S, double>) {
      own result = p;
      system_.kick(own(q), result, 0.5);
      p = result;
    }
  }
  void soft_force(const column& q, column& f) const override {
    if constexpr (HasQuadraticPart<S>) {
      own result(q.size());
      system_.soft_force(own(q), result);
      f = result;
    }
  }
  std::shared_ptr<const quadratic_part> quadratic() const override {
    if constexpr (HasQuadraticPart<S>) return quadratic_part::of(system_);
    return nullptr;
  }
  void derivative(const column& q, const column& v, column& g) const override {
    if constexpr (HasForceDerivative<S>) {
      own result(q.size());
      system_.force_derivative(own(q), own(v), result);
      g = result;
    }
  }
  void velocity(const column& p, column& v) const override {
    if constexpr (HasVelocity<S, double>) {
      own result(p.size());
      system_.velocity(own(p), result);
      v = result;
    }
  }
  void velocity_slope(const column& p, const column& v, column& g) const override {
    if constexpr (exact_velocity) {
      vector<D, N> result(p.size());
      system_.velocity(lifted(p, v), result);
      for (Eigen::Index i = 0; i < p.size(); ++i) g[i] = result[i].derivative[0];
    } else {
      const auto at = [&](const column& x) {
        column result(x.size());
        velocity(x, result);
        return result;
      };
      g = difference_along(at, p, v);
    }
  }
  double kinetic_slope(const column& p, const column& v) const override {
    if constexpr (exact_kinetic) {
      return system_.kinetic_energy(lifted(p, v)).derivative[0];
    } else if constexpr (HasKineticEnergy<S, double>) {
      return difference_along([&](const column& x) { return system_.kinetic_energy(own(x)); }, p, v);
    }
    return 0.0;
  }

 private:
  static vector<D, N> lifted(const column& x, const column& v) {
    vector<D, N> result(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      result[i].value = x[i];
      result[i].derivative[0] = v[i];
    }
    return result;
  }

  const S& system_;
};

/// What a system says of the force in several ways, compared at one point after the other.
force_check examine_force(const force_source& its, const std::vector<Eigen::VectorXd>& points,
                          const std::vector<Eigen::VectorXd>& momenta, const Eigen::VectorXd& lengths,
                          const Eigen::VectorXd& lengths_of_momenta);

}  // namespace detail

}  // namespace nysalt
