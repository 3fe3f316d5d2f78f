// SPDX-License-Identifier: BSL-1.0
// A method as data: letters and coefficients; repeated, or with letters O.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/method.hpp"

namespace nysalt {

/// Declared properties of a method beside its coefficients.
struct method_properties {
  int order;                        ///< order in h, as declared
  bool symmetric;                   ///< whether a step back undoes a step
  bool requires_quadratic_kinetic;  ///< whether the order is for quadratic K(p) only
};

/// A method as data: letters, coefficients and what it promises. A method from a file is one, and any
/// other method can be made one, so that a program need not be compiled for each.
/// A step costs what that of the type-level method does, and one decision a letter.
class tabulated : public method_properties {
 public:
  using word = run_time_word;

  /// A method from letters, one coefficient for each of their slots, and promises. Throws
  /// std::invalid_argument unless there is a finite coefficient for each slot.
  tabulated(std::string name, run_time_word letters, std::vector<double> coefficients,
            const method_properties& properties)
      : method_properties(properties),
        name_(std::move(name)),
        letters_(std::move(letters)),
        coefficients_(std::move(coefficients)) {
    if (coefficients_.size() != letters_.slots) {
      throw std::invalid_argument(
          sentence("{}: coefficients must fit the letters, got {} coefficients for the {} letters {}{}",
                   name_, coefficients_.size(), letters_.length, letters_.letters(),
                   letters_.slots > letters_.length ? " (G and H take two)" : ""));
    }
    for (std::size_t i = 0; i < coefficients_.size(); ++i) {
      if (std::isfinite(coefficients_[i])) continue;
      throw std::invalid_argument(
          sentence("{}: coefficient {} must be finite, got {}", name_, i + 1, coefficients_[i]));
    }
  }

  /// Any other method. A tuned one guards its step and system: take its anywhere().
  template <Method M>
  explicit tabulated(const M& method)
      : tabulated(method.name(), run_time_word(word_of(method)), to_vector(method.coefficients()),
                  {method.order, method.symmetric, method.requires_quadratic_kinetic}) {
    if constexpr (TypeLevelWord<typename M::word>) {
      static_assert(are_known_letters<typename M::word>(),
                    "nysalt: a table must have letters of known_letters only, in "
                    "nysalt/detail/known_letters.hpp; step "
                    "the word as a type, or make the table with its system: tabulated(method, system)");
    }
    static_assert(
        !requires { method.require_validity(std::string(), 1.0); },
        "nysalt: a tuned method is valid at one step and for one system, which a table cannot guard; "
        "take its anywhere()");
  }

  /// A method whose word has letters of one's own, as they act on this system: it steps no other.
  template <Method M, System S>
    requires(TypeLevelWord<typename M::word>)
  tabulated(const M& method, const S& system)
      : tabulated(method.name(), run_time_word(word_of(method), system), to_vector(method.coefficients()),
                  {method.order, method.symmetric, method.requires_quadratic_kinetic}) {}

  const run_time_word& letters() const { return letters_; }
  std::vector<double> coefficients() const { return coefficients_; }
  const std::string& name() const { return name_; }

 private:
  static std::vector<double> to_vector(const auto& c) { return {c.begin(), c.end()}; }

  std::string name_;
  run_time_word letters_;
  std::vector<double> coefficients_;
};

namespace detail {

/// As a table. A method without members is read where it is static: inlined, g++ 12 takes one in a temporary
/// for uninitialised.
template <Method M>
tabulated table_of(const M& method) {
  if constexpr (std::is_empty_v<M> && std::is_default_constructible_v<M>) {
    static const M same{};
    return tabulated(same);
  } else {
    return tabulated(method);
  }
}

/// The table of a method that is to step this system at this step. Throws std::invalid_argument where a tuned
/// method is not valid.
template <System S, Method M>
tabulated table_for(const M& method, const S& system, double step) {
  require_suited<M, S>();
  if constexpr (requires { method.require_validity(std::string(), step); }) {
    method.require_validity(describe(system), step);
    return table_for(method.anywhere(), system, step);
  } else if constexpr (has_own_letters<typename M::word>()) {
    return tabulated(method, system);
  } else {
    return table_of(method);
  }
}

}  // namespace detail

/// Several steps of a method with an equal part of the step each, as one method: the first coefficient of a
/// letter goes with h, the second of gradient kicks with h^3, that of displaced kicks with h^2. Throws
/// std::invalid_argument unless there is at least one step, or, of several steps, if the word has letters O
/// or a processor.
inline tabulated repeated(const tabulated& method, int times) {
  const run_time_word& word = method.letters();
  if (times == 1) return method;
  if (times < 1 || word.stochastic_letters > 0 || word.is_processed()) {
    throw std::invalid_argument(
        sentence("repeated: the number of steps must be at least 1 and the word without letters O and "
                 "processor, got {} steps of {}; place the letters O afterwards",
                 times, word.letters()));
  }
  const double part = 1.0 / times;
  std::string letters;
  std::vector<double> coefficients;
  const std::vector<double> of_one = method.coefficients();
  const auto part_of_second = [&](char letter) {
    return letter == displaced_kick::letter ? part * part : part * part * part;
  };
  for (int n = 0; n < times; ++n) {
    letters += word.letters();
    for (std::size_t i = 0; i < word.length; ++i) {
      for (std::size_t k = 0; k < word.slots_of(i); ++k) {
        coefficients.push_back(of_one[word.first_slot(i) + k] *
                               (k == 0 ? part : part_of_second(word.letters()[i])));
      }
    }
  }
  return {std::to_string(times) + " x " + method.name(), word.with_letters(letters), coefficients, method};
}

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
