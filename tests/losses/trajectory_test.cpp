// SPDX-License-Identifier: BSL-1.0
// Through which stages the loss over trajectories is minimised.
#include <boost/test/unit_test.hpp>

#include <vector>

#include "nysalt/losses/loss_choice.hpp"

using namespace nysalt;

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
