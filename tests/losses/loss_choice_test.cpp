// SPDX-License-Identifier: BSL-1.0
// A loss by its name.
#include "nysalt/losses/loss_choice.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"

using namespace nysalt;
using nysalt::test::refuses;
using kind = loss_choice::kind;

BOOST_AUTO_TEST_CASE(names_are_understood_and_told_again) {
  BOOST_TEST((loss_named("state") == loss_choice{kind::state, 1}));
  BOOST_TEST((loss_named("state") == loss_choice{}));
  BOOST_TEST((loss_named("state:5") == loss_choice{kind::state, 5}));
  BOOST_TEST((loss_named("energy") == loss_choice{kind::energy, 1}));
  BOOST_TEST((loss_named("energy:10") == loss_choice{kind::energy, 10}));
  BOOST_TEST((loss_named("covariance") == loss_choice{kind::covariance, 1}));
  BOOST_TEST((loss_named("state:5") != loss_named("state:6")));
  for (const char* name : {"state:1", "state:5", "energy:10", "covariance"}) {
    BOOST_TEST(loss_named(name).description() == name);
  }
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
