// SPDX-License-Identifier: BSL-1.0
// A method: a word with its coefficients, what it promises, and where it is valid.
#pragma once

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/systems/requirements.hpp"

namespace nysalt {

/// Declared properties of a method beside its coefficients; measured in the tests.
struct method_properties {
  int order;                        ///< order in h, as declared
  bool symmetric;                   ///< whether a step back undoes a step
  bool requires_quadratic_kinetic;  ///< whether the order is for quadratic K(p) only
};

/// Step and system of a learned method, which is not meant for any other.
struct method_validity {
  double step = 0.0;     ///< step of learning
  std::string system{};  ///< system of learning, as describe() returns it
  std::string kind{};    ///< kind of that system, as kind_of() returns it; empty where unknown
  /// Energies of the training data; empty where they are not known.
  std::optional<energy_range> energies{};
};

/// A method: letters, coefficients and what it promises. A learned one refuses other steps and systems than
/// its own; anywhere() gives the plain method to those who ask for it.
class method : public method_properties {
 public:
  /// A method from letters, one coefficient for each of their slots, and promises. Throws
  /// std::invalid_argument unless there is a finite coefficient for each slot.
  method(std::string name, const word& letters, std::vector<double> coefficients,
         const method_properties& properties, std::optional<method_validity> validity = {});

  const word& letters() const { return letters_; }                           ///< letters, in their order
  const std::vector<double>& coefficients() const { return coefficients_; }  ///< one for each slot
  const std::string& name() const { return name_; }                          ///< name in tables
  /// Step and system of learning; empty of a method that was not learned.
  const std::optional<method_validity>& validity() const { return validity_; }

  /// Whether the training data include energies like the energy of a state; true where the energies of the
  /// data are not known. Outside the method runs all the same, and may err more: of many starts
  /// learning/reach.hpp computes whether that is chance.
  template <HasEnergy<double> S>
  bool has_seen(const S& system, const phase_point<double, S::dimension>& state) const {
    return !validity_ || !validity_->energies || validity_->energies->contains(energy<double>(system, state));
  }
  /// The method without its validity: for any step and system.
  method anywhere() const;

  /// Throws std::invalid_argument where the method is not valid: at a step other than the learned one
  /// (to 1e-9 relative, as steps are typed in decimals) or for another system.
  void require_validity(const std::string& system, double step) const;

 private:
  std::string name_;
  word letters_;
  std::vector<double> coefficients_;
  std::optional<method_validity> validity_;
};

namespace detail {

/// Throws std::invalid_argument, naming the method, if its order needs a quadratic kinetic energy that the
/// system has not.
template <System S>
void require_kinetic_energy_for(const method& method, const S& system) {
  if (!method.requires_quadratic_kinetic || has_quadratic_kinetic(system)) return;
  throw std::invalid_argument(
      sentence("{}: the kinetic energy must be quadratic for the order of the method, got that of {}; take a "
               "method of any K(p), as blanes_moan_s10",
               method.name(), describe(system)));
}

}  // namespace detail

/// The stepper of a method on a system, with the noise of its bath. Throws std::invalid_argument where the
/// method is not valid on the system or the stepper refuses the word.
template <System S, NoiseSource Noise = no_noise>
stepper<S, double, Noise> make_stepper(const S& system, const method& method, double step,
                                       const Noise& noise = {}) {
  if constexpr (!detail::steps_by_own_letters_only<S>) require_suited<S>();
  if (method.validity()) method.require_validity(describe(system), step);
  detail::require_kinetic_energy_for(method, system);
  return {system, method.letters(), method.coefficients(), step, noise};
}
template <System S, NoiseSource Noise = no_noise>
void make_stepper(const S&& system, const method& method, double step,
                  const Noise& noise = {}) = delete;  // it would refer to a temporary

/// Several steps of a method with an equal part of the step each, as one method: a coefficient of a letter
/// goes with the power of h that the letter gives it. Throws std::invalid_argument unless there is at least
/// one step, or, of several steps, if the word has letters O or a processor.
inline method repeated(const method& method, int times);

/// A method in a bath: its word with letters O at a placement, under the same name. Throws
/// std::invalid_argument if the method has letters O already, no central letter, or a validity: take its
/// anywhere().
inline method thermostat(const method& method, placement where);

inline method::method(std::string name, const word& letters, std::vector<double> coefficients,
                      const method_properties& properties, std::optional<method_validity> validity)
    : method_properties(properties),
      name_(std::move(name)),
      letters_(letters),
      coefficients_(std::move(coefficients)),
      validity_(std::move(validity)) {
  if (coefficients_.size() != letters_.slots) {
    throw std::invalid_argument(
        sentence("{}: coefficients must fit the letters, got {} coefficients for the {} letters {}{}", name_,
                 coefficients_.size(), letters_.length, letters_.view(),
                 letters_.slots > letters_.length ? " (G and H take two)" : ""));
  }
  for (std::size_t i = 0; i < coefficients_.size(); ++i) {
    if (std::isfinite(coefficients_[i])) continue;
    throw std::invalid_argument(
        sentence("{}: coefficient {} must be finite, got {}", name_, i + 1, coefficients_[i]));
  }
}

inline method method::anywhere() const {
  method result = *this;
  result.validity_.reset();
  return result;
}

inline void method::require_validity(const std::string& system, double step) const {
  if (!validity_) return;
  if (std::abs(step - validity_->step) > 1e-9 * std::abs(validity_->step)) {
    throw std::invalid_argument(
        sentence("learned:{} must run at the step {}, at which it was learned, got {}; learn it there, or "
                 "use anywhere()",
                 name_, validity_->step, step));
  }
  if (system != validity_->system) {
    throw std::invalid_argument(sentence(
        "learned:{} must run on {}, for which it was learned, got {}; learn it there, or use anywhere()",
        name_, validity_->system, system));
  }
}

inline method repeated(const method& method, int times) {
  const word& letters = method.letters();
  if (times == 1) return method;
  if (times < 1 || letters.stochastic_letters > 0 || letters.is_processed()) {
    throw std::invalid_argument(
        sentence("repeated: the number of steps must be at least 1 and the word without letters O and "
                 "processor, got {} steps of {}; place the letters O afterwards",
                 times, letters.view()));
  }
  const double part = 1.0 / times;
  std::string text;
  std::vector<double> coefficients;
  for (int n = 0; n < times; ++n) {
    text += letters.view();
    std::size_t slot = 0;
    for (std::size_t i = 0; i < letters.length; ++i) {
      for (std::size_t k = 0; k < letters.slots_of(i); ++k, ++slot) {
        double factor = part;
        for (int power = 1; k > 0 && power < letters.facts(i).power_of_second; ++power) factor *= part;
        coefficients.push_back(method.coefficients()[slot] * factor);
      }
    }
  }
  return {sentence("{} x {}", times, method.name()), letters.with_letters(text), coefficients, method};
}

inline method thermostat(const method& method, placement where) {
  if (method.validity()) {
    throw std::invalid_argument(
        sentence("thermostat: the method must not be of one system, got {}, which was learned for {}; take "
                 "its anywhere()",
                 method.name(), method.validity()->system));
  }
  const word letters = thermostatted(method.letters(), where);
  return nysalt::method(method.name(), letters,
                        detail::thermostatted_coefficients(method.letters(), where, method.coefficients()),
                        {detail::thermostatted_order(where, method.order, method.symmetric),
                         where != placement::end && method.symmetric, method.requires_quadratic_kinetic});
}

}  // namespace nysalt
