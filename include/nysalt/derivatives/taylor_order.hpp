// SPDX-License-Identifier: BSL-1.0
// The order of a method, exactly: where the Taylor expansion of one step leaves that of the flow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "nysalt/derivatives/order_probe.hpp"
#include "nysalt/method.hpp"

namespace nysalt {

/// The orders of a method where K = p M^-1 p / 2, and where K(p) may be anything. 0: not consistent;
/// highest_taylor_order: this or more.
struct taylor_orders {
  int quadratic_kinetic;  ///< the order where K is quadratic in p
  int any_kinetic;        ///< the order for every K(p)
  friend bool operator==(const taylor_orders&, const taylor_orders&) = default;  ///< equal in both
};

namespace detail {

/// |x - y| coordinate by coordinate, power by power.
inline std::array<taylor, 6> distances(const phase_point<taylor, 3>& x, const phase_point<taylor, 3>& y) {
  std::array<taylor, 6> result{x.q[0] - y.q[0], x.q[1] - y.q[1], x.q[2] - y.q[2],
                               x.p[0] - y.p[0], x.p[1] - y.p[1], x.p[2] - y.p[2]};
  for (taylor& distance : result) {
    for (double& c : distance.coefficient) c = std::abs(c);
  }
  return result;
}

/// Tables are printed to ten digits or more. Hence a power of h agrees if errors of 1e-10 in the coefficients
/// of the letters, at their worst, explain the difference: sum_i |dx/dc_i| 1e-10. This is sharp where large
/// terms cancel, and rounding stays far below: it acts like errors of some 1e-16.
template <class Coefficients>
int order_on(const order_probe& system, Coefficients coefficients, const auto& one_step,
             const phase_point<taylor, 3>& exact) {
  const auto x = one_step(system, coefficients);
  const auto error = distances(x, exact);
  std::array<taylor, 6> tolerance;
  for (double& c : coefficients) {
    const double as_given = c;
    c += 1e-10;
    const auto change = distances(one_step(system, coefficients), x);
    for (std::size_t i = 0; i < 6; ++i) tolerance[i] += change[i];
    c = as_given;
  }
  for (std::size_t k = 1; k < taylor::terms; ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      const bool agrees = error[i].coefficient[k] <= tolerance[i].coefficient[k];
      if (!agrees) return static_cast<int>(k) - 1;  // nor does what is not a number
    }
  }
  return highest_taylor_order;
}

}  // namespace detail

/// The orders of a composition of any kind. The coefficients are a container of double that can be copied;
/// one_step(system, coefficients) is the phase_point after a step of length 1 from system.start().
template <class Coefficients>
taylor_orders taylor_order_of(const Coefficients& coefficients, const auto& one_step) {
  const order_probe quadratic(true);
  const order_probe any(false);
  return {detail::order_on(quadratic, coefficients, one_step, quadratic.flow()),
          detail::order_on(any, coefficients, one_step, any.flow())};
}

namespace detail {

/// To which powers of h the processor of a word is even, so that P(-h) P(h)^-1 is the identity.
inline taylor_orders order_of_processor(const run_time_word& word, const std::vector<double>& coefficients) {
  const auto there_and_back = [&](const order_probe& system, const std::vector<double>& c) {
    auto x = system.start();
    stepper<order_probe, run_time_word>(system, pre_processor(word), pre_processor_coefficients(word, c), 1.0)
        .step(x);
    stepper<order_probe, run_time_word>(system, post_processor(word), post_processor_coefficients(word, c),
                                        1.0)
        .step(x);
    return x;
  };
  const order_probe quadratic(true);
  const order_probe any(false);
  return {order_on(quadratic, coefficients, there_and_back, quadratic.start()),
          order_on(any, coefficients, there_and_back, any.start())};
}

}  // namespace detail

/// The orders of a word with coefficients that are known to ten decimals: one step on a generic system, and
/// its flow, are expanded in powers of h and compared. Cost: as many steps in series as there are letters,
/// some 2 ms for 23. The error of n steps of a processed word is that of P(-h) K^n P(h)^-1: it is the least
/// order of one step and of none.
///
/// Words with rotations obey the order conditions of those with drifts: all that these use of K is that it is
/// quadratic in p, and so is K with the quadratic part of V.
template <Word W>
taylor_orders taylor_order(const W& word, const typename W::template coefficients<double>& coefficients) {
  std::string letters = word.letters();
  for (char& letter : letters) {
    detail::with_letter(letter, known_letters{},
                        [&](auto flow) { letter = decltype(flow)::same_order_as::letter; });
  }
  const run_time_word split(letters);
  const std::vector<double> as_data(coefficients.begin(), coefficients.end());
  const auto of_step = taylor_order_of(as_data, [&](const order_probe& system, const auto& c) {
    auto x = system.start();
    stepper<order_probe, run_time_word>(system, split, c, 1.0).step(x);
    return x;
  });
  if (!split.is_processed()) return of_step;
  const auto of_none = detail::order_of_processor(split, as_data);
  return {std::min(of_step.quadratic_kinetic, of_none.quadratic_kinetic),
          std::min(of_step.any_kinetic, of_none.any_kinetic)};
}

/// The orders of a method, at its own coefficients.
template <Method M>
taylor_orders taylor_order(const M& method) {
  return taylor_order(word_of(method), method.coefficients());
}

}  // namespace nysalt
