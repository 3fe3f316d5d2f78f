// SPDX-License-Identifier: BSL-1.0
#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/path_error.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/methods/blanes_moan.hpp"
#include "nysalt/methods/mclachlan.hpp"
#include "nysalt/methods/verlet.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, 6>;
const fpu_chain<3> chain(50.0);
const auto stiff_energy = [](const state& x) { return chain.stiff_energy(x); };

std::vector<state> starts(std::uint64_t count) {
  std::vector<state> result;
  for (std::uint64_t n = 0; n < count; ++n) result.push_back(fpu_law<3>(chain)(1, n));
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(relative_rms_by_hand) {
  BOOST_TEST(relative_rms({1.1, 2.0}, {1.0, 2.0}) == std::sqrt(0.01 / 2.0),
             boost::test_tools::tolerance(1e-14));
  BOOST_TEST(relative_rms({1.1, 2.0}, {1.1, 2.0}) == 0.0);
  BOOST_TEST(relative_rms({-2.0}, {-1.0}) == 1.0);
}

BOOST_AUTO_TEST_CASE(a_method_has_no_error_against_itself) {
  const auto from = starts(5);
  const auto own = reference_paths(chain, fine_steps<verlet>(.01), .01, 20, from, stiff_energy);
  const auto result = path_error(chain, verlet(), .01, from, own, stiff_energy);
  // Stepping without merging differs by rounding, some 20 of them a step, which 20 steps magnify little.
  BOOST_TEST(result.error.mean <= 20 * 20 * eps * 10.0);
  BOOST_TEST(path_error(chain, verlet_2x(), .01, from, own, stiff_energy).error.mean > 1e-3);
}

BOOST_AUTO_TEST_CASE(paths_are_sampled_after_each_step) {
  const auto from = starts(2);
  const auto paths = reference_paths(chain, fine_steps<>(5e-4), .01, 7, from, stiff_energy);
  BOOST_TEST(paths.values.size() == 2);
  BOOST_TEST(paths.values[1].size() == 7);
  auto x = from[1];
  fine_steps<>(5e-4).advance(chain, x, .07);
  BOOST_TEST(paths.values[1][6] == stiff_energy(x),
             boost::test_tools::tolerance(1e-11));  // rounding of 140 fine steps
}

BOOST_AUTO_TEST_CASE(evaluations_are_counted_for_one_whole_trajectory) {
  const auto from = starts(3);
  const auto paths = reference_paths(chain, fine_steps<>(5e-4), .01, 20, from, stiff_energy);
  const auto evaluations = [&](const auto& method) {
    return path_error(chain, method, .01, from, paths, stiff_energy).evaluations_per_time * .2;
  };
  const auto near = boost::test_tools::tolerance(8 * eps);
  BOOST_TEST(evaluations(verlet()) == 21.0, near);  // one for each step, and one to begin
  BOOST_TEST(evaluations(verlet_2x()) == 41.0, near);
  BOOST_TEST(evaluations(mclachlan2()) == 40.0, near);  // none to begin with a drift
  BOOST_TEST(evaluations(srkn6b()) == 121.0, near);
}

// At z = 2.5 Verlet is unstable and magnifies stiff motion by 4 in a step; in 8 steps a chain that hardly
// moves does not get there.
BOOST_AUTO_TEST_CASE(diverged_trajectories_are_counted_and_left_out) {
  constexpr double step = .05;
  constexpr std::int64_t steps = 8;
  const auto exciting = starts(2);
  const state at_rest{vector<double, 6>::Constant(1e-3), vector<double, 6>::Constant(1e-3)};
  const auto observable = [](const state& x) { return 2.0 + x.q[0]; };
  const fine_steps<> reference(5e-4);
  const std::vector<state> both{exciting[0], at_rest, exciting[1]};
  const auto paths = reference_paths(chain, reference, step, steps, both, observable);
  const auto of_both = path_error(chain, verlet(), step, both, paths, observable);
  const auto alone = path_error(chain, verlet(), step, {at_rest}, {step, {paths.values[1]}}, observable);
  BOOST_TEST(of_both.diverged == 2);
  BOOST_REQUIRE(of_both.diverged_at.size() == 2);
  for (const auto n : of_both.diverged_at) {
    BOOST_TEST(n > 0);
    BOOST_TEST(n <= steps);
  }
  BOOST_TEST(alone.diverged == 0);
  BOOST_TEST(of_both.error.mean == alone.error.mean);
  BOOST_TEST(std::isnan(of_both.error.standard_error));
  const auto none_left =
      path_error(chain, verlet(), step, {exciting[0]}, {step, {paths.values[0]}}, observable);
  BOOST_TEST(none_left.diverged == 1);
  BOOST_TEST(std::isnan(none_left.error.mean));
  BOOST_TEST(none_left.evaluations_per_time * step * steps == 9.0);  // all the same: one a step, one to begin
}

BOOST_AUTO_TEST_CASE(a_reference_at_another_step_is_refused) {
  const auto from = starts(2);
  const auto paths = reference_paths(chain, fine_steps<>(5e-4), .02, 5, from, stiff_energy);
  const auto judge = [&](double step, const std::vector<state>& of) {
    path_error(chain, verlet(), step, of, paths, stiff_energy);
  };
  BOOST_CHECK_NO_THROW(judge(.02, from));
  BOOST_TEST(refuses<std::invalid_argument>([&] { judge(.01, from); }, {"path_error", "0.01", "0.02"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { judge(.02, {from[0]}); }, {"path_error", "1 starts"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { relative_rms({1.0}, {0.0}); }, {"never 0"}));
}
