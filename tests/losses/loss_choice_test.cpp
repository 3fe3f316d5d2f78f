// SPDX-License-Identifier: BSL-1.0
// A loss by its name, and the stages through which it is minimised.
#include "nysalt/losses/loss_choice.hpp"

#include <boost/test/unit_test.hpp>

#include <vector>

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

namespace {

std::vector<std::vector<int>> times(const char* loss, int shortest) {
  const loss_choice choice = loss_named(loss);
  std::vector<std::vector<int>> result;
  for (const auto& stage : choice.kind->stages(choice.steps, shortest)) result.push_back(stage.steps);
  return result;
}

using several = std::vector<std::vector<int>>;

}  // namespace

BOOST_AUTO_TEST_CASE(stages_lead_from_a_few_steps_to_whole_trajectories) {
  const auto stages = times("trajectory", 320);
  BOOST_TEST_REQUIRE(stages.size() == 3U);
  BOOST_TEST((stages[0] == std::vector{1, 2, 4}));
  BOOST_TEST((stages[1] == std::vector{1, 4, 9, 16}));
  BOOST_TEST_REQUIRE(stages[2].size() == 16U);
  BOOST_TEST(stages[2].front() == 20);
  BOOST_TEST(stages[2].back() == 320);
}

BOOST_AUTO_TEST_CASE(early_stages_use_a_few_windows_and_the_last_at_all) {
  const auto& kind = *loss_named("trajectory").kind;
  for (const int shortest : {17, 100, 320}) {
    const auto stages = kind.stages(1, shortest);
    for (std::size_t n = 0; n + 1 < stages.size(); ++n) {
      BOOST_TEST(stages[n].apart >= stages[n].steps.back());
      BOOST_TEST(shortest / stages[n].apart <= 2);
    }
    BOOST_TEST(stages.back().apart == shortest);
  }
}

BOOST_AUTO_TEST_CASE(short_trajectories_have_fewer_stages) {
  BOOST_TEST((times("trajectory", 1) == several{{1}}));
  BOOST_TEST((times("trajectory", 3) == several{{1, 2, 3}}));
  BOOST_TEST((times("trajectory", 4) == several{{1, 2, 3, 4}}));
  BOOST_TEST(times("trajectory", 5).size() == 2U);
  BOOST_TEST(times("trajectory", 16).size() == 2U);
  BOOST_TEST(times("trajectory", 17).size() == 3U);
}

BOOST_AUTO_TEST_CASE(losses_after_k_steps_use_a_few_windows_first) {
  BOOST_TEST((times("state:1", 320) == several{{1}, {1}}));
  BOOST_TEST((times("energy:7", 320) == several{{7}, {7}}));
  const auto stages = loss_named("state:5").kind->stages(5, 320);
  BOOST_TEST(stages[0].apart == 80);
  BOOST_TEST(stages[1].apart == 1);
}
