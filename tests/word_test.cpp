// SPDX-License-Identifier: BSL-1.0
// What a word knows of itself, at compile time.
#include <boost/test/unit_test.hpp>

#include "nysalt/detail/palindrome.hpp"
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"

using namespace nysalt;

namespace {

using O = ornstein_uhlenbeck;

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

// The bath reads no force and moves no q: costs are those of the word without it, but for the merging that
// it prevents, where the force is reused instead.
static_assert(costs<word<kick, drift, O, drift, kick>>(1, 1, 2));
static_assert(costs<word<O, kick, drift, kick, O>>(1, 1, 2));
static_assert(costs<word<drift, kick, O, kick, drift>>(0, 1, 1));
static_assert(costs<word<kick, drift, kick, O>>(1, 1, 2));
static_assert(costs<word<kick, O, kick, drift>>(0, 1, 1));

// Where the force is evaluated, and whether it must be stored for later letters.
constexpr auto none = evaluation::none;
constexpr auto unshared = evaluation::unshared;
constexpr auto shared = evaluation::shared;

template <class W>
constexpr bool evaluates(const auto& in_step, const auto& in_loop, const auto& in_last) {
  return W::plan.in_step == in_step && W::plan.in_loop == in_loop && W::plan.in_last == in_last;
}
// Only where a run stops is Verlet's force needed again: to take the half kick back.
static_assert(evaluates<word<kick, drift, kick>>(std::array{unshared, none, unshared},
                                                 std::array{none, none, unshared},
                                                 std::array{none, none, shared}));
static_assert(evaluates<word<drift, kick, drift>>(std::array{none, unshared, none},
                                                  std::array{none, unshared, none},
                                                  std::array{none, unshared, none}));
static_assert(evaluates<alternating_word<kick, drift, 5>>(std::array{unshared, none, unshared, none,
                                                                     unshared},
                                                          std::array{none, none, unshared, none, unshared},
                                                          std::array{none, none, unshared, none, shared}));
// The next letter, or the next step, reads it too.
static_assert(evaluates<word<kick, kick, drift>>(std::array{shared, none, none},
                                                 std::array{shared, none, none},
                                                 std::array{shared, none, none}));
static_assert(evaluates<word<lonely_kick, drift, lonely_kick>>(std::array{unshared, none, unshared},
                                                               std::array{none, none, shared},
                                                               std::array{none, none, shared}));
static_assert(evaluates<word<drift, kick, lonely_kick>>(std::array{none, shared, none},
                                                        std::array{none, shared, none},
                                                        std::array{none, shared, none}));
static_assert(evaluates<word<kick>>(std::array{unshared}, std::array{none}, std::array{none}));

// Half kicks around a bath share one force; those around a drift and a bath leave it for the next step.
static_assert(evaluates<word<drift, kick, O, kick, drift>>(std::array{none, shared, none, none, none},
                                                           std::array{none, shared, none, none, none},
                                                           std::array{none, shared, none, none, none}));
static_assert(evaluates<word<O, kick, drift, kick, O>>(std::array{none, unshared, none, unshared, none},
                                                       std::array{none, none, none, shared, none},
                                                       std::array{none, none, none, shared, none}));

static_assert(word<kick, drift, kick>::merges);
static_assert(!word<O, drift, O>::merges && word<O, drift, O>::merges_half_steps);
static_assert(!word<O, drift>::merges_half_steps && !word<drift, O>::merges_half_steps);
static_assert(!word<kick, drift, O, drift, kick>::merges_half_steps &&
              word<kick, drift, O, drift, kick>::merges);
static_assert(word<O, drift, O, kick, O>::stochastic_letters == 3);
static_assert(word<O, drift, O, kick, O>::stochastic_number(0) == 0 &&
              word<O, drift, O, kick, O>::stochastic_number(2) == 1 &&
              word<O, drift, O, kick, O>::stochastic_number(4) == 2);
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
