// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <stdexcept>

#include "nysalt/bath.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/flow.hpp"
#include "nysalt/noise.hpp"

namespace nysalt {

/// O: the flow of the bath over t = c h, dp = -gamma p dt + sigma M^{1/2} dW, exactly:
///   p <- e^{-gamma t} p + s M^{1/2} xi,  s^2 = sigma^2 (1 - e^{-2 gamma t})/(2 gamma),  xi standard normal
/// [leimkuhler_matthews_2015]. Its noise is the noise of the interval of the step which it covers: the
/// letters O of a word share the step in their order.
struct ornstein_uhlenbeck {
  static constexpr char letter = detail::bath_letter;
  static constexpr std::size_t slots = 1;
  static constexpr field reads = field::none;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = false;
  static constexpr bool additive = false;  // two letters draw other noise than one
  static constexpr bool stochastic = true;
  static constexpr splitting splits = splitting::any;
  static constexpr bool invertible = false;
  using same_order_as = ornstein_uhlenbeck;

  template <System S, Scalar T>
  static constexpr bool serves = true;

  /// e^{-gamma c h} and s. Damping without noise (sigma = 0) may go back in time; noise may not.
  template <Scalar C>
  struct prepared {
    C decay{1.0};      ///< e^{-gamma c h}
    C deviation{0.0};  ///< s, for unit mass
  };

  /// Throws std::invalid_argument where noise would have to go back in time.
  template <Scalar C>
  static prepared<C> prepare(const C& c, double h, const bath& heat_bath) {
    const C time = c * h;
    if (heat_bath.sigma() > 0.0 && any(time < C(0.0))) {
      throw std::invalid_argument(sentence(
          "a letter O: its coefficient must have the sign of the step, {}, as noise must not go back in time",
          h));
    }
    return {heat_bath.decay(time), heat_bath.deviation(time)};
  }

  /// p <- decay p
  template <System S, Scalar T, CoefficientOf<T> C>
  static void damp(const S&, const C& decay, flow_state<T, S::dimension>& x) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] = x.p[i] * decay;
  }

  /// p <- decay p + deviation M^{1/2} xi
  template <System S, Scalar T, CoefficientOf<T> C>
  static void apply(const S& system, const prepared<C>& flow, const vector<T, S::dimension>& xi,
                    flow_state<T, S::dimension>& x) {
    const C decay = flow.decay;
    const C of_unit_mass = flow.deviation;
    if (detail::facts_of(system).has_unit_mass) {
      for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] = x.p[i] * decay + xi[i] * of_unit_mass;
      return;
    }
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const C deviation = of_unit_mass * root_mass(system, i);
      x.p[i] = x.p[i] * decay + xi[i] * deviation;
    }
  }
};

}  // namespace nysalt
