// SPDX-License-Identifier: BSL-1.0
// Letters, words, methods and baths that do not suit a system or each other. The comments are explained in
// check.py.
#include "common.hpp"
#include "nysalt/word.hpp"
#include "nysalt/families/gradient_composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/methods/s_aia.hpp"
#include "nysalt/method.hpp"
#include "nysalt/word.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/sum_of_parts.hpp"
#include "nysalt/systems/textbook.hpp"

// expect: nysalt: the order of this method needs a quadratic kinetic energy, but the system has a kinetic
//   energy of its own; take one of any K(p), as blanes_moan_s10, and as reference
//   fine_steps(step, blanes_moan_s10())
// expect: nysalt: the letter G needs a quadratic kinetic energy, and a force that can be differentiated
// expect: nysalt: the letter D needs a quadratic kinetic energy
namespace other_kinetic_energy {
inline void use(const relativistic& system) {
  nysalt::make_stepper(system, nysalt::srkn11b(), 0.1);
  {
    const auto coefficients = nysalt::fg_chin::coefficients(nysalt::fg_chin::start());
    // [gradient_kick_on_other_kinetic_energy]
    nysalt::stepper<relativistic, nysalt::fg_chin::word>(system, coefficients, 0.1);
    // [/gradient_kick_on_other_kinetic_energy]
  }
  {
    const auto coefficients = nysalt::fd_chin::coefficients(nysalt::fd_chin::start());
    // [displaced_kick_on_other_kinetic_energy]
    nysalt::stepper<relativistic, nysalt::fd_chin::word>(system, coefficients, 0.1);
    // [/displaced_kick_on_other_kinetic_energy]
  }
}
}  // namespace other_kinetic_energy

// expect GNU: required for the satisfaction of 'NystromSystem<S>' [with S = relativistic]
// expect Clang: because 'relativistic' does not satisfy 'NystromSystem'
namespace other_kinetic_energy_in_bath {
inline void use() {
  // [other_kinetic_energy_in_bath]
  const nysalt::in_bath<relativistic> system({}, nysalt::bath::of_sigma(0.1, 0.2));
  // [/other_kinetic_energy_in_bath]
  system.bath();
}
}  // namespace other_kinetic_energy_in_bath

// expect: nysalt: the letters R, S, H need a system that declares a quadratic part: modes() and soft_force(q,
//   f), see nysalt/system.hpp
namespace rotation_without_quadratic_part {
struct spring : well {
  nysalt::normal_modes modes() const { return {Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Ones(1)}; }
#ifdef NYSALT_CONTROL
  template <class T>
  void soft_force(const nysalt::vector<T, 1>&, nysalt::vector<T, 1>& f) const {
    f[0] = T(0.0);
  }
#endif
};
inline void use(const spring& system) {
  // [rotation_without_quadratic_part]
  using impulse = nysalt::word<nysalt::soft_kick, nysalt::rotation, nysalt::soft_kick>;
  nysalt::stepper<spring, impulse>(system, {0.5, 1.0, 0.5}, 0.1);
  // [/rotation_without_quadratic_part]
}
}  // namespace rotation_without_quadratic_part

// expect: nysalt: the system does not serve a letter of the word
// expect: nysalt: a table must have letters of known_letters only
// expect: nysalt: a letter of one's own in a word as data evaluates what it needs itself: reads = field::none
// expect: nysalt: a word as data carries letters of one's own for systems that are templates over the
//   scalar; step the word by its type
// expect: nysalt: a letter of one's own takes a character that no known letter has
namespace letters_of_ones_own {
/// For some systems only.
struct pull {
  static constexpr char letter = 'U';
  static constexpr std::size_t slots = 1;
  static constexpr nysalt::field reads = nysalt::field::none;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = false;
  static constexpr bool additive = true;
#ifdef NYSALT_CONTROL
  template <nysalt::System S, nysalt::Scalar T>
  static constexpr bool serves = true;
#else
  // [letter_that_is_not_served]
  template <nysalt::System S, nysalt::Scalar T>
  static constexpr bool serves = S::dimension > 1;
  // [/letter_that_is_not_served]
#endif
  template <nysalt::Scalar C>
  static C prepare(const C& c, double h) {
    return c * h;
  }
  static void apply(const auto&, const auto& c, auto& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += c;
  }
};
/// A kick of twice the force that calls itself B.
struct strong_kick : nysalt::kick {
  static void apply(const auto&, const auto& c, auto& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += 2.0 * c * x.f[i];
  }
};
#ifdef NYSALT_CONTROL
using kicked = nysalt::kick;
constexpr char name = 'a';
#else
// [table_of_another_letter]
using kicked = strong_kick;
// [/table_of_another_letter]
// [own_letter_of_a_known_name]
constexpr char name = 'A';
// [/own_letter_of_a_known_name]
#endif
struct method {
  using word = nysalt::word<kicked, nysalt::drift>;
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::array<double, 2> coefficients() { return {1.0, 1.0}; }
  static std::string name() { return "strong"; }
};
template <char Letter>
struct own_drift : nysalt::exact_flow<Letter> {
  static void apply(const auto&, const auto&, auto&, auto&) {}
};
struct own_kick : own_drift<'b'> {
#ifndef NYSALT_CONTROL
  // [own_letter_that_reads_the_force]
  static constexpr nysalt::field reads = nysalt::field::whole;
  // [/own_letter_that_reads_the_force]
#endif
};
struct spring {
  static constexpr int dimension = 1;
  // [own_letter_of_a_black_box]
  void force(const nysalt::vector<double, 1>& q, nysalt::vector<double, 1>& f) const { f[0] = -q[0]; }
  // [/own_letter_of_a_black_box]
};
inline void use(const nysalt::pendulum& system, const either<well, spring>& black_box) {
  nysalt::stepper<nysalt::pendulum, nysalt::word<pull, nysalt::drift>>(system, {1.0, 1.0}, 0.1);
  nysalt::tabulated table{method()};
  nysalt::run_time_word(nysalt::word<nysalt::drift, own_kick>{}, system);
  nysalt::run_time_word(nysalt::word<own_drift<'a'>, nysalt::kick>{}, black_box);
  nysalt::run_time_word(nysalt::word<own_drift<name>, nysalt::kick>{}, system);
}
}  // namespace letters_of_ones_own

// expect: nysalt: a kick of parts needs a system that declares them, such as sum_of_parts
namespace kick_of_parts_without_parts {
inline void use() {
#ifdef NYSALT_CONTROL
  const nysalt::sum_of_parts<nysalt::pendulum> system{nysalt::pendulum()};
#else
  // [kick_of_parts_without_parts]
  const nysalt::pendulum system;
  // [/kick_of_parts_without_parts]
#endif
  nysalt::stepper<std::remove_const_t<decltype(system)>,
                  nysalt::word<nysalt::kick_of_part<0>, nysalt::drift>>(system, {1.0, 1.0}, 0.1);
}
}  // namespace kick_of_parts_without_parts

// expect: nysalt: s_aia2_for needs the system's highest frequency; give the system frequency_bands(), or use
//   s_aia2(step * frequency)
// expect: nysalt: phase_fitted_for needs the system's highest frequency; give the system modes() or
//   frequency_bands(), or use phase_fitted(step * frequency)
namespace methods_for_an_unknown_frequency {
struct of_unknown_frequency : well {
#ifdef NYSALT_CONTROL
  std::vector<nysalt::frequency_band> frequency_bands() const {
    return {{ 1.0, 1.5 }};
  }
#endif
};
inline void use() {
  // [s_aia2_without_frequency_bands]
  nysalt::s_aia2_for(of_unknown_frequency(), 0.1);
  // [/s_aia2_without_frequency_bands]
  // [phase_fitted_without_frequency]
  nysalt::phase_fitted_for<nysalt::fg_chin, nysalt::chin4a>(of_unknown_frequency(), 0.1);
  // [/phase_fitted_without_frequency]
}
}  // namespace methods_for_an_unknown_frequency

// expect: nysalt: the letters A, B, D, G split H into K and V, and R, S, H into its quadratic part and the
//   rest: a word has those of one splitting
// expect: nysalt: a word with an even number of letters has no central letter to split
// expect: nysalt: a word needs a letter beside those of the bath
namespace words_that_cannot_be {
// [middle_of_an_even_word]
using euler = nysalt::word<nysalt::kick, nysalt::drift>;
// [/middle_of_an_even_word]
using O = nysalt::ornstein_uhlenbeck;
#ifdef NYSALT_CONTROL
using mixed = nysalt::word<nysalt::soft_kick, nysalt::rotation, nysalt::soft_kick>;
constexpr auto place = nysalt::placement::end;
using some = nysalt::word<O, nysalt::drift>;
#else
// [word_of_two_forces]
using mixed = nysalt::word<nysalt::kick, nysalt::rotation, nysalt::soft_kick>;
// [/word_of_two_forces]
constexpr auto place = nysalt::placement::middle;
// [word_of_bath_alone]
using some = nysalt::word<O, O>;
// [/word_of_bath_alone]
#endif
static_assert(mixed::length == 3);
static_assert(nysalt::thermostatted_word<euler, place>::length == 3);
static_assert(nysalt::conservative_word<some>::length == 1);
}  // namespace words_that_cannot_be

// expect: nysalt: no classical method has this name
// expect: nysalt: a tuned method is valid for the system that it was learned for; thermostat its anywhere()
// expect: nysalt: this word has its letters O already
namespace methods_that_cannot_be {
inline void use(const nysalt::tuned_method<nysalt::nystrom>& tuned) {
#ifdef NYSALT_CONTROL
  nysalt::classical<"pefrl">::coefficients();
  nysalt::thermostat(tuned.anywhere(), nysalt::placement::end);
  nysalt::thermostat(nysalt::verlet(), nysalt::placement::symmetric).coefficients();
#else
  // [classical_method_without_row]
  nysalt::classical<"perfl">::coefficients();
  // [/classical_method_without_row]
  // [thermostat_of_tuned_method]
  nysalt::thermostat(tuned, nysalt::placement::end);
  // [/thermostat_of_tuned_method]
  // [thermostatted_twice]
  nysalt::thermostat(nysalt::baoab(), nysalt::placement::symmetric).coefficients();
  // [/thermostatted_twice]
#endif
}
}  // namespace methods_that_cannot_be

// Coefficients with derivatives by two parameters cannot step a state that carries one derivative.
// expect GNU: required for the satisfaction of 'CoefficientOf<C, T>' [with C = nysalt::dual<double, 2>; T =
//   nysalt::dual<double, 1>]
// expect Clang: because 'CoefficientOf<nysalt::dual<double, 2>, nysalt::dual<double, 1> >' evaluated to false
namespace coefficient_of_foreign_scalar {
using two = nysalt::dual<double, 2>;
#ifdef NYSALT_CONTROL
using state = two;
#else
// [coefficient_of_foreign_scalar]
using state = nysalt::dual<double, 1>;
// [/coefficient_of_foreign_scalar]
#endif
inline void use(const nysalt::pendulum& system) {
  const nysalt::stepper<nysalt::pendulum, nysalt::nystrom::word, two> fixed(
      system, nysalt::nystrom::coefficients(std::array<two, 2>{0.5, 0.4}), 0.1);
  nysalt::flow_state<state, 1> x;
  fixed.step(x);
}
}  // namespace coefficient_of_foreign_scalar
