// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/methods/tabulated.hpp"

namespace nysalt {

/// A method in a bath: its word with letters O at a placement.
template <placement P, Method M>
  requires TypeLevelWord<typename M::word>
class thermostatted_method {
 public:
  using word = thermostatted_word<typename M::word, P>;  ///< word with letters O
  /// Order without noise: 2 at most.
  static constexpr int order = thermostatted_order(P, M::order, M::symmetric);
  static constexpr bool symmetric = P != placement::end && M::symmetric;  ///< false with O at the end
  static constexpr bool requires_quadratic_kinetic =
      M::requires_quadratic_kinetic;  ///< value of the method without the bath

  /// Holds a copy of the method.
  explicit thermostatted_method(const M& plain) : plain_(plain) {}

  /// Coefficients of the method and of the letters O, in the order of the word.
  typename word::template coefficients<double> coefficients() const {
    return thermostatted_coefficients<word>(P, plain_.coefficients());
  }
  /// METHOD_PLACEMENT, as in verlet_end.
  std::string name() const { return sentence("{}_{}", plain_.name(), to_string(P)); }

 private:
  M plain_;
};

/// The method in a bath. A tuned one does not compile: take its anywhere().
template <placement P, Method M>
  requires TypeLevelWord<typename M::word>
thermostatted_method<P, M> thermostat(const M& method) {
  static_assert(
      !requires { method.require_validity(std::string(), 1.0); },
      "nysalt: a tuned method is valid for the system that it was learned for; thermostat its anywhere()");
  return thermostatted_method<P, M>(method);
}

/// A thermostatted method as data. Throws std::invalid_argument if the method has letters O already, or no
/// central letter.
inline tabulated thermostat(const tabulated& method, placement where) {
  const run_time_word letters = thermostatted(method.letters(), where);
  return tabulated(method.name(), letters,
                   thermostatted_coefficients(method.letters(), where, method.coefficients()),
                   {thermostatted_order(where, method.order, method.symmetric),
                    where != placement::end && method.symmetric, method.requires_quadratic_kinetic});
}

}  // namespace nysalt
