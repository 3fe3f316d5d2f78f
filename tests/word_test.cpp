// SPDX-License-Identifier: BSL-1.0
// What a word knows of itself, at compile time.
#include <boost/test/unit_test.hpp>

#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/palindrome.hpp"

using namespace nysalt;

namespace {

/// Like a kick, but not to be merged.
struct lonely_kick : kick {
  static constexpr bool additive = false;
};

template <class W>
constexpr bool costs(int to_open, int per_step, int plain) {
  return W::evaluations_to_open == to_open && W::evaluations_per_step == per_step &&
         W::evaluations_of_plain_step == plain;
}

}  // namespace

static_assert(costs<word<kick, drift, kick>>(1, 1, 2));  // Verlet: the last force is the next first
static_assert(costs<word<drift, kick, drift>>(0, 1, 1));
static_assert(costs<alternating_word<kick, drift, 5>>(1, 2, 3));
static_assert(costs<alternating_word<drift, kick, 5>>(0, 2, 2));
static_assert(costs<alternating_word<kick, drift, 23>>(1, 11, 12));
static_assert(costs<word<kick, drift>>(0, 1, 1));  // symplectic Euler
static_assert(costs<word<drift, kick>>(0, 1, 1));
static_assert(costs<word<drift>>(0, 0, 0));
static_assert(costs<word<kick>>(1, 0, 1));                             // q never moves
static_assert(costs<word<kick, kick>>(1, 0, 1));                       // one force serves both
static_assert(costs<word<lonely_kick, drift, lonely_kick>>(1, 1, 2));  // not merged, yet reused
static_assert(costs<word<kick, kick, drift>>(0, 1, 1));

static_assert(word<kick, drift, kick>::merges);
static_assert(!word<kick, drift>::merges);
static_assert(!word<drift>::merges);
static_assert(!word<lonely_kick, drift, lonely_kick>::merges);
static_assert(word<kick, drift, kick>::first_in_loop == 1);
static_assert(word<kick, drift>::first_in_loop == 0);

static_assert(TypeLevelWord<word<kick>> && !TypeLevelWord<kick> && !TypeLevelWord<int>);
static_assert(std::is_same_v<alternating_word<kick, drift, 5>, word<kick, drift, kick, drift, kick>>);

BOOST_AUTO_TEST_CASE(a_word_spells_itself) {
  BOOST_TEST((word<kick, drift, drift>::letters()) == "BAA");
  BOOST_TEST((alternating_word<drift, kick, 9>::letters()) == "ABABABABA");
}

BOOST_AUTO_TEST_CASE(a_palindrome_follows_from_its_first_coefficients) {
  BOOST_TEST((palindrome<3>({}) == std::array{0.5, 1.0, 0.5}));
  BOOST_TEST((palindrome<5>({0.25}) == std::array{0.25, 0.5, 0.5, 0.5, 0.25}));
  BOOST_TEST((palindrome<7>({0.125, 0.25}) == std::array{0.125, 0.25, 0.375, 0.5, 0.375, 0.25, 0.125}));
}
