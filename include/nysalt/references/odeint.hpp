// SPDX-License-Identifier: BSL-1.0
// References by steppers of Boost.Odeint, and methods as steppers for Boost.Odeint.
#pragma once

#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <boost/numeric/odeint/stepper/stepper_categories.hpp>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/bath.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/method.hpp"

namespace nysalt {

/// Boost.Odeint's Runge-Kutta-Fehlberg 7(8) with step control [ahnert_mulansky_2011]: absolute and relative
/// error of a step below the stated tolerance. For any kinetic energy, and independent of our own steps. In a
/// bath of friction without noise it is the flow of the damped motion.
class odeint_reference {
 public:
  /// Throws std::invalid_argument unless 0 < tolerance < 1.
  explicit odeint_reference(double tolerance) : tolerance_(tolerance) {
    if (!(tolerance > 0.0 && tolerance < 1.0)) {
      throw std::invalid_argument(
          sentence("odeint_reference: the tolerance must lie in (0, 1), got {}", tolerance));
    }
  }

  /// x becomes the state a time t later. Returns the force evaluations. Throws std::invalid_argument if the
  /// system is in a noisy bath.
  template <SeparableSystem S>
  std::int64_t advance(const S& system, phase_point<double, S::dimension>& x, double t) const {
    namespace odeint = boost::numeric::odeint;
    using state = std::vector<double>;  // q, then p
    const Eigen::Index n = size(system);
    const double friction = friction_of(system);
    auto q = x.q;
    auto p = x.p;
    auto rate = x.q;
    std::int64_t evaluations = 0;
    const auto derivative = [&](const state& y, state& dydt, double) {
      for (Eigen::Index i = 0; i < n; ++i) {
        q[i] = y[static_cast<std::size_t>(i)];
        p[i] = y[static_cast<std::size_t>(n + i)];
      }
      velocity<double>(system, p, rate);
      for (Eigen::Index i = 0; i < n; ++i) dydt[static_cast<std::size_t>(i)] = rate[i];
      force<double>(system, q, rate);
      ++evaluations;
      for (Eigen::Index i = 0; i < n; ++i) dydt[static_cast<std::size_t>(n + i)] = rate[i] - friction * p[i];
    };
    state y(x.q.begin(), x.q.end());
    y.insert(y.end(), x.p.begin(), x.p.end());
    using controlled = odeint::controlled_runge_kutta<odeint::runge_kutta_fehlberg78<state>>;
    const controlled stepper(controlled::error_checker_type(tolerance_, tolerance_));
    odeint::integrate_adaptive(stepper, derivative, y, 0.0, t, t / 16.0);  // a first guess, then controlled
    for (Eigen::Index i = 0; i < n; ++i) {
      x.q[i] = y[static_cast<std::size_t>(i)];
      x.p[i] = y[static_cast<std::size_t>(n + i)];
    }
    return evaluations;
  }

  double tolerance() const {
    return tolerance_;
  }  ///< tolerance of the error of a step, absolute and relative
  /// A reference with a hundredth of the tolerance.
  odeint_reference finer() const { return odeint_reference(0.01 * tolerance_); }
  std::string description() const {
    return sentence("Boost.Odeint Runge-Kutta-Fehlberg 7(8) with tolerance {}", tolerance_);
  }

 private:
  template <System S>
  static double friction_of(const S& system) {
    if constexpr (HasBath<S>) {
      const bath& heat_bath = system.bath();
      if (heat_bath.sigma() == 0.0) return heat_bath.friction();
      throw std::invalid_argument(
          sentence("odeint_reference: the motion must be without noise, got a {}; take fine_paths",
                   heat_bath.description()));
    }
    return 0.0;
  }

  double tolerance_;
};

// Any method of ours in Boost.Odeint's integrate functions.

/// Models Boost.Odeint's Stepper, for integrate_const and integrate_n_steps with an observer; the system
/// argument of those is ours, the state a phase_point.
///
/// Odeint hands the state out after each step and may change it, so every step is a plain one: nothing is
/// merged, and a word that begins and ends with a kick costs one evaluation more than in our own loop.
/// A learned method checks at each step that it may take the step.
class odeint_stepper {
 public:
  using value_type = double;                                     ///< value type, as Odeint requires
  using time_type = double;                                      ///< time type, as Odeint requires
  using order_type = unsigned short;                             ///< order type, as Odeint requires
  using stepper_category = boost::numeric::odeint::stepper_tag;  ///< stepper category, as Odeint requires

  /// A stepper with a copy of the method.
  explicit odeint_stepper(nysalt::method method) : method_(std::move(method)) {}

  order_type order() const { return static_cast<order_type>(method_.order); }  ///< order of the method

  /// One plain step of x by dt. Cost: the word's evaluations_of_plain_step, and the making of a stepper.
  template <System S>
  void do_step(const S& system, phase_point<double, S::dimension>& x, double /*t*/, double dt) const {
    make_stepper(system, method_, dt).step(x);
  }

 private:
  nysalt::method method_;
};

}  // namespace nysalt
