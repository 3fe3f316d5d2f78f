// SPDX-License-Identifier: BSL-1.0
// A method: a word with its coefficients, and what it promises.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <optional>
#include <stdexcept>
#include <string>

#include "nysalt/detail/requirements.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/family.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt {

/// A word with coefficients and declared properties:
///   word, coefficients(), name()      and letters() where the word is a run_time_word
///   order, symmetric                  as declared; measured in the tests
///   requires_quadratic_kinetic        the order holds for K = p M^-1 p / 2 only
template <class M>
concept Method = Word<typename M::word> && requires(const M& method) {
  { method.coefficients() } -> std::same_as<typename M::word::template coefficients<double>>;
  { method.name() } -> std::convertible_to<std::string>;
  { method.order } -> std::convertible_to<int>;
  { method.symmetric } -> std::convertible_to<bool>;
  { method.requires_quadratic_kinetic } -> std::convertible_to<bool>;
} && (TypeLevelWord<typename M::word> || requires(const M& method) {
                   { method.letters() } -> std::convertible_to<run_time_word>;
                 });

/// A family at a theta, usable at any step.
template <Family F>
class member {
 public:
  using family = F;  ///< family of the method
  using word = typename F::word;
  static constexpr int order = F::order;
  static constexpr bool symmetric = F::symmetric;
  static constexpr bool requires_quadratic_kinetic = F::requires_quadratic_kinetic;

  /// The member of a family at theta. Throws std::invalid_argument if a parameter is out of its range.
  explicit member(const parameters_of<F>& theta, const F& family = {}) : theta_(theta), family_(family) {
    require_in_range<F>(theta);
  }

  const parameters_of<F>& parameters() const { return theta_; }
  typename word::template coefficients<double> coefficients() const { return family_.coefficients(theta_); }
  word letters() const { return word_of(family_); }
  std::string name() const { return std::string(F::name); }

 private:
  parameters_of<F> theta_;
  [[no_unique_address]] F family_;
};

/// A member of a family with the step and the system of learning; it refuses any other. It knows the energies
/// that it was learned on, too.
/// `anywhere()` gives the plain member to those who ask for it; at_size_of() of learning/at_other_size.hpp
/// tries it at another size of the system.
template <Family F>
class tuned_method {
 public:
  using family = F;  ///< family of the method
  using word = typename F::word;
  static constexpr int order = F::order;
  static constexpr bool symmetric = F::symmetric;
  static constexpr bool requires_quadratic_kinetic = F::requires_quadratic_kinetic;

  /// A tuned method. `system` is the text of describe(), `kind` that of kind_of(). Without energies, has_seen
  /// is true everywhere; without a kind, at_size_of() finds no other size of it.
  tuned_method(const member<F>& plain, double step, std::string system,
               std::optional<energy_range> energies = {}, std::string kind = {})
      : member_(plain),
        step_(step),
        system_(std::move(system)),
        kind_(std::move(kind)),
        energies_(energies) {}

  const parameters_of<F>& parameters() const { return member_.parameters(); }
  typename word::template coefficients<double> coefficients() const { return member_.coefficients(); }
  word letters() const { return member_.letters(); }
  std::string name() const { return "learned:" + member_.name(); }
  double step() const { return step_; }                  ///< step of learning
  const std::string& system() const { return system_; }  ///< system of learning, as describe() returns it
  /// Kind of that system; empty where unknown.
  const std::string& kind() const { return kind_; }
  /// Energies of the training data; empty where they are not known.
  const std::optional<energy_range>& energies() const { return energies_; }
  /// Whether the training data include energies like that of a state. Outside it runs all the same, and may
  /// err more: of many starts learning/energies_outside.hpp computes whether that is chance.
  template <HasEnergy<double> S>
  bool has_seen(const S& system, const phase_point<double, S::dimension>& state) const {
    return !energies_ || energies_->contains(energy<double>(system, state));
  }
  const member<F>& anywhere() const { return member_; }  ///< valid at any step, for any system

  /// Throws std::invalid_argument where the method is not valid: at a step other than the learned one
  /// (to 1e-9 relative, as steps are typed in decimals) or for another system.
  void require_validity(const std::string& system, double step) const {
    if (std::abs(step - step_) > 1e-9 * std::abs(step_)) {
      throw std::invalid_argument(sentence(
          "{} must run at the step {}, at which it was learned, got {}; learn it there, or use anywhere()",
          name(), step_, step));
    }
    if (system != system_) {
      throw std::invalid_argument(
          sentence("{} must run on {}, for which it was learned, got {}; learn it there, or use anywhere()",
                   name(), system_, system));
    }
  }

 private:
  member<F> member_;
  double step_;
  std::string system_;
  std::string kind_;
  std::optional<energy_range> energies_;
};

/// The stepper of a method on a system, with the noise of its bath. Throws std::invalid_argument where the
/// method is not valid on the system or the stepper refuses the word.
template <System S, Method M, NoiseSource Noise = no_noise>
stepper<S, typename M::word, double, Noise> make_stepper(const S& system, const M& method, double step,
                                                         const Noise& noise = {}) {
  // Letters of one's own may know a system that is not K + V.
  if constexpr (SeparableSystem<S> || detail::has_known_letters<typename M::word>()) require_suited<M, S>();
  if constexpr (requires { method.require_validity(std::string(), step); }) {
    method.require_validity(describe(system), step);
  }
  if (method.requires_quadratic_kinetic &&
      !has_quadratic_kinetic(system)) {  // known before only of a type-level method
    throw std::invalid_argument(sentence(
        "{}: the kinetic energy must be quadratic for the order of the method, got that of {}; take a "
        "method of any K(p), as blanes_moan_s10",
        method.name(), describe(system)));
  }
  return {system, word_of(method), method.coefficients(), step, noise};
}
template <System S, Method M, NoiseSource Noise = no_noise>
void make_stepper(const S&& system, const M& method, double step,
                  const Noise& noise = {}) = delete;  // it would refer to a temporary

}  // namespace nysalt
