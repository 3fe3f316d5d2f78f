// SPDX-License-Identifier: BSL-1.0
// A word as data knows of itself what the type-level word knows.
#include "nysalt/run_time_word.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "laws/models.hpp"
#include "nysalt/detail/palindrome.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <TypeLevelWord W>
void compare() {
  const run_time_word as_data{W{}};
  BOOST_TEST_CONTEXT(W::letters()) {
    BOOST_TEST(as_data.letters() == W::letters());
    BOOST_TEST(as_data.length == W::length);
    BOOST_TEST(as_data.slots == W::slots);
    BOOST_TEST((as_data.reads == W::reads));
    BOOST_TEST(as_data.force_derivatives == W::force_derivatives);
    BOOST_TEST(as_data.merges == W::merges);
    BOOST_TEST(as_data.merges_half_steps == W::merges_half_steps);
    BOOST_TEST(as_data.stochastic_letters == W::stochastic_letters);
    BOOST_TEST(as_data.first_in_loop() == W::first_in_loop);
    BOOST_TEST(as_data.evaluations_per_step == W::evaluations_per_step);
    BOOST_TEST(as_data.evaluations_to_open == W::evaluations_to_open);
    BOOST_TEST(as_data.evaluations_of_plain_step == W::evaluations_of_plain_step);
    for (std::size_t i = 0; i < W::length; ++i) {
      BOOST_TEST(as_data.first_slot(i) == W::first_slot(i));
      BOOST_TEST(as_data.slots_of(i) == W::first_slot(i + 1) - W::first_slot(i));
      BOOST_TEST((as_data.plan().in_step[i] == W::plan.in_step[i]));
      BOOST_TEST((as_data.plan().in_loop[i] == W::plan.in_loop[i]));
      BOOST_TEST((as_data.plan().in_last[i] == W::plan.in_last[i]));
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(it_knows_what_the_type_knows, M, methods) { compare<typename M::word>(); }

BOOST_AUTO_TEST_CASE(also_of_odd_words) {
  compare<word<kick>>();
  compare<word<drift>>();
  compare<word<drift, kick>>();
  compare<word<kick, drift>>();
  compare<word<kick, kick, drift>>();
  compare<word<drift, kick, kick, drift>>();
  compare<word<kick, drift, kick, kick>>();
}

BOOST_AUTO_TEST_CASE(also_of_gradient_kicks_and_rotations) {
  compare<word<gradient_kick>>();
  compare<word<drift, gradient_kick, drift>>();
  compare<word<gradient_kick, drift, gradient_kick>>();  // these do not merge
  compare<word<kick, drift, gradient_kick, drift, kick>>();
  compare<word<rotation, soft_kick, rotation>>();
  compare<word<soft_kick, rotation, soft_kick>>();
  compare<word<rotation, soft_kick, rotation, soft_gradient_kick, rotation, soft_kick, rotation>>();
  compare<word<soft_kick, rotation, ornstein_uhlenbeck, rotation, soft_kick>>();
}

BOOST_AUTO_TEST_CASE(also_of_words_with_letters_of_the_bath) {
  using O = ornstein_uhlenbeck;
  compare<word<kick, drift, O, drift, kick>>();
  compare<word<O, kick, drift, kick, O>>();
  compare<word<drift, kick, O, kick, drift>>();
  compare<word<drift, kick, drift, kick, drift, O>>();
  compare<word<O, drift, kick>>();
  compare<word<O, drift>>();
  compare<word<O, O, drift, O, kick, O, O>>();
}

BOOST_AUTO_TEST_CASE(a_word_splits_the_hamiltonian_in_one_way_or_the_other) {
  for (const char* mixed : {"BAS", "SRB", "BAH", "GRS", "SRHRG", "RBR", "ASA", "RAS"}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { run_time_word{mixed}; }, {mixed, "A, B, G", "R, S, H"}));
  }
  for (const char* pure : {"BAG", "SRH", "RSR"}) {
    BOOST_TEST(!refuses<std::invalid_argument>([&] { run_time_word{pure}; }, {}));
  }
}

BOOST_AUTO_TEST_CASE(letters_that_are_not_known_are_refused) {
  BOOST_TEST(refuses<std::invalid_argument>([] { run_time_word(""); }, {"one or more"}));
  BOOST_TEST(
      refuses<std::invalid_argument>([] { run_time_word("AXB"); }, {"letter X", "A, B, G, D, R, S, H, O"}));
  for (const char* bath_alone : {"O", "OO"}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { run_time_word{bath_alone}; },
                                              {bath_alone, "a letter other than O"}));
  }
  BOOST_TEST(!refuses<std::invalid_argument>([] { run_time_word("AB"); }, {}));
  BOOST_TEST(!refuses<std::invalid_argument>([] { run_time_word("OA"); }, {}));
}
