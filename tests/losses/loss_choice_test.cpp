// SPDX-License-Identifier: BSL-1.0
// A loss by its name.
#include "nysalt/losses/loss_choice.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"

using namespace nysalt;
using nysalt::test::refuses;

BOOST_AUTO_TEST_CASE(names_are_understood_and_told_again) {
  const auto is = [](const char* text, std::string_view name, int steps) {
    const loss_choice loss = loss_named(text);
    return loss.kind->name == name && loss.steps == steps;
  };
  BOOST_TEST(is("state", "state", 1));
  BOOST_TEST((loss_named("trajectory") == loss_choice{}));
  BOOST_TEST(is("trajectory", "trajectory", 1));
  BOOST_TEST(is("state:5", "state", 5));
  BOOST_TEST(is("energy", "energy", 1));
  BOOST_TEST(is("energy:10", "energy", 10));
  BOOST_TEST(is("covariance", "covariance", 1));
  BOOST_TEST((loss_named("state:5") != loss_named("state:6")));
  for (const char* name :
       {"trajectory", "state:1", "state:5", "energy:10", "acceptance", "gaussian_acceptance", "covariance"}) {
    BOOST_TEST(loss_named(name).description() == name);
  }
}

BOOST_AUTO_TEST_CASE(each_loss_has_a_name_of_its_own_and_says_what_it_needs) {
  for (const loss_kind* kind : losses()) {
    BOOST_TEST(loss_named(kind->name).kind == kind);
    BOOST_TEST(kind->over_data != nullptr);
    BOOST_TEST((kind->asks_data() || !kind->counts_steps));
  }
  BOOST_TEST(loss_patterns(true) == "state:K, energy:K");
  BOOST_TEST(loss_patterns(false) == "trajectory, acceptance, gaussian_acceptance, covariance");
}

BOOST_AUTO_TEST_CASE(what_is_no_name_is_refused) {
  for (const char* name : {"", "State", "states", "state:", "state:0", "state:05", "state:-5", "state:+5",
                           "state: 5", "state:5 ", "state:5.0", "state:five", "state:5:6",
                           "energy:99999999999", "covariance:3", "covariance:", ":5"}) {
    BOOST_TEST_CONTEXT(name) {
      BOOST_TEST(refuses<std::invalid_argument>([&] { loss_named(name); },
                                                {name, "state:K", "energy:K", "covariance"}));
    }
  }
}
