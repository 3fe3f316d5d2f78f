// SPDX-License-Identifier: BSL-1.0
// Baths and letters O where they cannot be. The comments are explained in check.py.
#include "common.hpp"
#include "nysalt/detail/conservative_part.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/systems/in_bath.hpp"

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

// expect: nysalt: a tuned method is valid for the system that it was learned for; thermostat its anywhere()
namespace thermostat_of_tuned_method {
inline void use(const nysalt::tuned_method<nysalt::nystrom>& tuned) {
#ifdef NYSALT_CONTROL
  nysalt::thermostat<nysalt::placement::end>(tuned.anywhere());
#else
  // [thermostat_of_tuned_method]
  nysalt::thermostat<nysalt::placement::end>(tuned);
  // [/thermostat_of_tuned_method]
#endif
}
}  // namespace thermostat_of_tuned_method

// expect: nysalt: this word has its letters O already
namespace thermostatted_twice {
inline void use() {
#ifdef NYSALT_CONTROL
  nysalt::thermostat<nysalt::placement::symmetric>(nysalt::verlet()).coefficients();
#else
  // [thermostatted_twice]
  nysalt::thermostat<nysalt::placement::symmetric>(nysalt::baoab()).coefficients();
  // [/thermostatted_twice]
#endif
}
}  // namespace thermostatted_twice

// expect: nysalt: a word with an even number of letters has no central letter to split
namespace middle_of_an_even_word {
// [middle_of_an_even_word]
using euler = nysalt::word<nysalt::kick, nysalt::drift>;
// [/middle_of_an_even_word]
#ifdef NYSALT_CONTROL
constexpr auto place = nysalt::placement::end;
#else
constexpr auto place = nysalt::placement::middle;
#endif
static_assert(nysalt::thermostatted_word<euler, place>::length == 3);
}  // namespace middle_of_an_even_word

// expect: nysalt: a word needs a letter beside those of the bath
namespace word_of_bath_alone {
using O = nysalt::ornstein_uhlenbeck;
#ifdef NYSALT_CONTROL
using some = nysalt::word<O, nysalt::drift>;
#else
// [word_of_bath_alone]
using some = nysalt::word<O, O>;
// [/word_of_bath_alone]
#endif
static_assert(nysalt::conservative_word<some>::length == 1);
}  // namespace word_of_bath_alone

// expect: nysalt: fine paths need a method with one letter O
namespace fine_paths_of_two_letters {
inline void use() {
#ifdef NYSALT_CONTROL
  nysalt::fine_paths(0.1, nysalt::aboba());
#else
  // [fine_paths_of_two_letters]
  nysalt::fine_paths(0.1, nysalt::obabo());
  // [/fine_paths_of_two_letters]
#endif
}
}  // namespace fine_paths_of_two_letters
