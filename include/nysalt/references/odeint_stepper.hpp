// SPDX-License-Identifier: BSL-1.0
// Any method of ours in Boost.Odeint's integrate functions.
#pragma once

#include <boost/numeric/odeint/stepper/stepper_categories.hpp>
#include <utility>

#include "nysalt/method.hpp"

namespace nysalt {

/// Models Boost.Odeint's Stepper, for integrate_const and integrate_n_steps with an observer; the system
/// argument of those is ours, the state a phase_point.
///
/// Odeint hands the state out after each step and may change it, so every step is a plain one: nothing is
/// merged, and a word that begins and ends with a kick costs one evaluation more than in our own loop.
/// A tuned method checks at each step that it may take the step.
template <Method M>
class odeint_stepper {
 public:
  using value_type = double;                                     ///< value type, as Odeint requires
  using time_type = double;                                      ///< time type, as Odeint requires
  using order_type = unsigned short;                             ///< order type, as Odeint requires
  using stepper_category = boost::numeric::odeint::stepper_tag;  ///< stepper category, as Odeint requires

  /// A stepper with a copy of the method.
  explicit odeint_stepper(M method = M{}) : method_(std::move(method)) {}

  order_type order() const { return static_cast<order_type>(M::order); }  ///< order of the method

  /// One plain step of x by dt. Cost: the word's evaluations_of_plain_step, and the making of a stepper.
  template <System S>
  void do_step(const S& system, phase_point<double, S::dimension>& x, double /*t*/, double dt) const {
    make_stepper(system, method_, dt).step(x);
  }

 private:
  M method_;
};

}  // namespace nysalt
