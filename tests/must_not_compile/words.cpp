// SPDX-License-Identifier: BSL-1.0
// Letters, words, methods and baths that do not suit a system or each other. The comments are explained in
// check.py.
#include "common.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/textbook.hpp"
#include "nysalt/word.hpp"

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

// expect: nysalt: a letter of one's own evaluates what it needs itself: reads = field::none
// expect: nysalt: a letter of one's own takes a character that no known letter has
// expect: nysalt: letters of one's own must have different names; name one of them otherwise
namespace letters_of_ones_own {
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
#ifdef NYSALT_CONTROL
constexpr char name = 'a';
constexpr char other_name = 'c';
#else
// [own_letter_of_a_known_name]
constexpr char name = 'A';
// [/own_letter_of_a_known_name]
// [own_letters_of_one_name]
constexpr char other_name = 'b';
// [/own_letters_of_one_name]
#endif
inline void use(const nysalt::with_letters<nysalt::pendulum, own_kick>& system) {
  nysalt::stepper(system, nysalt::word_of<nysalt::drift, own_kick>(), {1.0, 1.0}, 0.1);
  nysalt::word_of<own_drift<name>, nysalt::kick>();
  nysalt::word_of<own_drift<other_name>, own_kick>();
}
}  // namespace letters_of_ones_own

// expect: refuse_unknown_letter
// expect: refuse_two_splittings
// expect: refuse_word_of_bath_only
// expect: refuse_word_without_letters
// expect: refuse_letters_of_processor
namespace words_that_cannot_be {
#ifdef NYSALT_CONTROL
constexpr nysalt::word misspelled{"ABA"};
constexpr nysalt::word of_two_splittings{"SRS"};
constexpr nysalt::word of_bath_alone{"OAO"};
constexpr nysalt::word without_letters{"A"};
constexpr nysalt::word with_processor{"ABA|BABA"};
#else
// [word_of_an_unknown_letter]
constexpr nysalt::word misspelled{"AXA"};
// [/word_of_an_unknown_letter]
// [word_of_two_splittings]
constexpr nysalt::word of_two_splittings{"BRS"};
// [/word_of_two_splittings]
// [word_of_bath_alone]
constexpr nysalt::word of_bath_alone{"OO"};
// [/word_of_bath_alone]
// [word_without_letters]
constexpr nysalt::word without_letters{""};
// [/word_without_letters]
// [word_of_another_processor]
constexpr nysalt::word with_processor{"ABA|BAAB"};
// [/word_of_another_processor]
#endif
}  // namespace words_that_cannot_be

// expect: nysalt: no classical method has this name; nysalt/methods/classical.hpp has those that there are
namespace methods_that_cannot_be {
#ifdef NYSALT_CONTROL
using method = nysalt::classical<"pefrl">;
#else
// [classical_method_without_row]
using method = nysalt::classical<"perfl">;
// [/classical_method_without_row]
#endif
inline void use() { method().coefficients(); }
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
  const nysalt::stepper<nysalt::pendulum, two> fixed(system, nysalt::word("BA"), {two(1.0), two(1.0)}, 0.1);
  nysalt::flow_state<state, 1> x;
  fixed.step(x);
}
}  // namespace coefficient_of_foreign_scalar
