// SPDX-License-Identifier: BSL-1.0
// The pairs that are learned from: made as told, and refused when they are not whole.
#include <boost/test/unit_test.hpp>

#include <limits>

#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
const fpu_chain<3> chain(50.0);
const fpu_law<3> law(chain);
flow_map_data<6> made(const data_options& options) {
  return make_flow_map_data(chain, law, fine_steps<>(1e-3), options);
}

}  // namespace

BOOST_AUTO_TEST_CASE(pairs_follow_the_reference_trajectory_by_trajectory) {
  const auto data = made({.step = 0.02, .horizon = 0.1, .trajectories = 3, .seed = 7});
  BOOST_TEST(data.pairs() == 15U);
  BOOST_TEST(data.trajectories() == 3U);
  for (std::size_t m = 0; m < 3; ++m) {
    BOOST_TEST((data.start[data.first_of[m]].q == law(7, m).q));
    for (std::size_t n = data.first_of[m]; n + 1 < data.first_of[m + 1]; ++n) {
      BOOST_TEST((data.finish[n].q == data.start[n + 1].q));
    }
  }
  auto x = data.start[4];
  fine_steps<>(1e-3).advance(chain, x, 0.02);
  BOOST_TEST((x.p == data.finish[4].p));
  BOOST_TEST((data.start[5].q != data.finish[4].q));  // a new trajectory begins there
  BOOST_TEST(data.finer.size() <= 16U);
  // 15 pairs of 20 steps of 11 and one more to open; the checks take twice the steps.
  BOOST_TEST(data.evaluations == 15 * 221 + static_cast<std::int64_t>(data.finer.size()) * 441);
  require_valid(data, chain);
}

BOOST_AUTO_TEST_CASE(what_holds_no_step_is_refused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const data_options& options, std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { made(options); }, words);
  };
  BOOST_TEST(refused({.step = 0.02, .horizon = 0.01}, {"no step of 0.02"}));
  BOOST_TEST(refused({.step = 0.02, .trajectories = 0}, {"0 trajectories"}));
  BOOST_TEST(refused({.step = -0.02}, {"positive", "-0.02"}));
  BOOST_TEST(refused({.step = nan}, {"positive"}));
  BOOST_TEST(refused({.step = 0.02, .horizon = nan}, {"finite"}));
  BOOST_TEST(refused({.step = 0.02, .horizon = 1e300}, {"memory"}));
  BOOST_TEST(refused({.step = 0.0205}, {"not a multiple"}));
}

BOOST_AUTO_TEST_CASE(a_start_that_does_not_fit_is_named) {
  const linear_chain four = linear_chain::between_walls(4, 1.0);
  const normal_around<Eigen::Dynamic> of_two({Eigen::VectorXd::Zero(2), Eigen::VectorXd::Zero(2)}, 0.1, 0.1);
  const auto make = [&] { make_flow_map_data(four, of_two, fine_steps<>(0.1), {.step = 0.1}); };
  BOOST_TEST(refuses<wrong>(make, {"start 0", "dimension"}));
}

BOOST_AUTO_TEST_CASE(data_that_are_not_whole_are_refused_with_the_pair) {
  const auto whole = made({.step = 0.02, .horizon = 0.1, .trajectories = 2});
  const auto refused = [&](const auto& spoil, std::initializer_list<std::string_view> words) {
    auto data = whole;
    spoil(data);
    return refuses<wrong>([&] { require_valid(data, chain); }, words);
  };
  BOOST_TEST(
      refused([](auto& d) { d.finish[3].q[1] = std::numeric_limits<double>::quiet_NaN(); }, {"pair 3"}));
  BOOST_TEST(refused([](auto& d) { d.start[7].p[0] = std::numeric_limits<double>::infinity(); }, {"pair 7"}));
  BOOST_TEST(refused([](auto& d) { d.finish.pop_back(); }, {"not whole", "9 finishes"}));
  BOOST_TEST(refused([](auto& d) { d.first_of.clear(); }, {"not whole", "0 trajectories"}));
  BOOST_TEST(refused([](auto& d) { d = {}; }, {"the data are of"}));
  BOOST_TEST(refused([](auto& d) { d.first_of.back() = 3; }, {"not whole"}));
  BOOST_TEST(refuses<wrong>([&] { require_valid(whole, fpu_chain<3>(49.0)); }, {"omega=50", "omega=49"}));
}
