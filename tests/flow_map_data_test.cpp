// SPDX-License-Identifier: BSL-1.0
// The pairs that are learned from: made as told, and refused when they are not whole.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/learning/require_valid.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "support/in_lanes.hpp"
#include "support/refusal.hpp"
#include "support/rounding.hpp"
#include "support/same_pairs.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
const fpu_chain<3> chain(50.0);
const fpu_law<3> law(chain);
flow_map_data made(const data_options& options) {
  return make_flow_map_data(chain, law, fine_steps<>(1e-3), options);
}

/// No force, and then one without bounds.
struct cliff {
  static constexpr int dimension = 1;
  static void force(const vector<double, 1>& q, vector<double, 1>& f) {
    f[0] = q[0] > 1.1 ? std::numeric_limits<double>::infinity() : 0.0;
  }
};

/// Starts of which 3 and every eighth after it are not finite. The third waits for a later one to be asked
/// for, so that with several threads it is not the first to fail.
struct third_fails_late {
  std::atomic<bool>* later_failed;
  bool waits;
  phase_point<double, 6> operator()(std::uint64_t seed, std::uint64_t n) const {
    auto x = law(seed, n);
    if (n % 8 != 3) return x;
    if (n > 3) *later_failed = true;
    for (int ms = 0; waits && n == 3 && !*later_failed && ms < 5000; ++ms) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    x.q[0] = std::numeric_limits<double>::quiet_NaN();
    return x;
  }
  static std::string description() { return "starts"; }
};

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
  phase_point<double, 6> x = data.start[4];
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
  BOOST_TEST(refused({.step = 0.02, .horizon = 0.01}, {"at least a step", "over 0.01 with the step 0.02"}));
  BOOST_TEST(refused({.step = 0.02, .trajectories = 0}, {"trajectories must be at least 1", "got 0"}));
  BOOST_TEST(refused({.step = -0.02}, {"positive", "-0.02"}));
  BOOST_TEST(refused({.step = nan}, {"positive"}));
  BOOST_TEST(refused({.step = 0.02, .horizon = nan}, {"finite"}));
  BOOST_TEST(refused({.step = 0.02, .horizon = 1e300}, {"memory"}));
  BOOST_TEST(refused({.step = 0.0205}, {"a multiple"}));
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
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(refused([=](auto& d) { d.finish[3].q[1] = nan; },
                     {"must be finite: q2 is nan", "finish of pair 3", "trajectory 0"}));
  BOOST_TEST(refused([](auto& d) { d.start[7].p[0] = -std::numeric_limits<double>::infinity(); },
                     {"must be finite: p1 is -inf", "start of pair 7", "trajectory 1"}));
  BOOST_TEST(refused([=](auto& d) { d.finer[1].second.p[5] = nan; },
                     {"p6 is nan", fmt::format("finer finish of pair {}", whole.finer[1].first)}));
  BOOST_TEST(refused([](auto& d) { d.finer[0].first = 10; }, {"must be whole", "pair 10 of 10"}));
  BOOST_TEST(refused([=](auto& d) { d.step = nan; }, {"step of the data", "nan"}));
  BOOST_TEST(refused([](auto& d) { d.step = 0.0; }, {"step of the data", "got 0"}));
  BOOST_TEST(refused([](auto& d) { d.finish.resize(9); }, {"must be whole", "9 finishes"}));
  BOOST_TEST(refused([](auto& d) { d.first_of.clear(); }, {"must be whole", "0 trajectories"}));
  BOOST_TEST(refused([](auto& d) { d = {}; }, {"the data must be of"}));
  BOOST_TEST(refused([](auto& d) { d.first_of.back() = 3; }, {"must be whole"}));
  BOOST_TEST(refuses<wrong>([&] { require_valid(whole, fpu_chain<3>(49.0)); }, {"omega=50", "omega=49"}));
}

BOOST_AUTO_TEST_CASE(the_number_of_threads_changes_no_bit) {
  const auto with = [](int threads, std::uint64_t seed) {
    return made({.step = 0.02, .horizon = 0.1, .trajectories = 41, .seed = seed, .threads = threads});
  };
  const auto one = with(1, 7);
  require_valid(one, chain);
  for (const int threads : {2, 5}) {
    const auto data = with(threads, 7);
    BOOST_TEST(same_bits(data, one));
    BOOST_TEST(!same_bits(data, with(threads, 8)));
  }
  BOOST_TEST(refuses<wrong>([&] { with(0, 7); }, {"threads must be at least one", "0"}));
}

BOOST_AUTO_TEST_CASE(every_trajectory_has_its_own_checks) {
  // 16 of the 205 pairs: one in each sixteenth.
  const auto data = made({.step = 0.02, .horizon = 0.1, .trajectories = 41, .threads = 3});
  std::set<std::size_t> checked;
  std::set<std::size_t> sixteenths;
  for (const auto& [pair, finish] : data.finer) {
    BOOST_TEST(checked.insert(pair).second);
    BOOST_TEST(sixteenths.insert((16 * pair + 15) / 205).second);
    phase_point<double, 6> x = data.start[pair];
    fine_steps<>(5e-4).advance(chain, x, 0.02);
    BOOST_TEST((x.q == finish.q));
    BOOST_TEST((x.q != data.finish[pair].q));  // that is another step
  }
  BOOST_TEST(checked.size() == 16U);
}

// Of M trajectories of S steps: a stride of M S/16 would see starts alone where M = 16 k - 1 and S = 16.
BOOST_AUTO_TEST_CASE(checks_are_spread_over_trajectories_and_along_them) {
  for (std::size_t trajectories = 1; trajectories <= 400; ++trajectories) {
    for (const std::size_t steps : {1U, 2U, 3U, 5U, 8U, 10U, 16U, 17U, 20U, 32U, 50U, 100U, 128U, 1000U}) {
      const std::size_t all = trajectories * steps;
      const auto pairs = detail::spread_pairs(all, 16);
      std::set<std::size_t> whose;
      std::set<std::size_t> when;  // in eighths of a trajectory
      std::size_t starts = 0;
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        BOOST_REQUIRE(pairs[k] < all);
        BOOST_REQUIRE((k == 0 || pairs[k - 1] < pairs[k]));
        whose.insert(pairs[k] / steps);
        when.insert(pairs[k] % steps * 8 / steps);
        starts += pairs[k] % steps == 0 ? 1U : 0U;
      }
      BOOST_TEST_CONTEXT(trajectories << " trajectories of " << steps << " steps") {
        BOOST_TEST(pairs.size() == std::min<std::size_t>(16, all));
        BOOST_TEST(whose.size() + 1 >= std::min<std::size_t>(8, trajectories));
        // Sixteen places at random miss more than half of eight eighths once in 10^6; starts are at most
        // half.
        if (steps >= 8 && all >= 128) BOOST_TEST(when.size() >= 4U);
        if (steps >= 8 && all >= 128) BOOST_TEST(starts <= 8U);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(of_several_failures_the_lowest_trajectory_is_named) {
  for (const int threads : {1, 2, 5}) {
    std::atomic<bool> later_failed = false;
    const auto make = [&] {
      make_flow_map_data(chain, third_fails_late{&later_failed, threads > 1}, fine_steps<>(1e-3),
                         {.step = 0.02, .horizon = 0.1, .trajectories = 400, .threads = threads});
    };
    BOOST_TEST(refuses<wrong>(make, {"start 3 of starts", "must be finite", "q1 is "}));
    BOOST_TEST(later_failed == (threads > 1));  // so the first thread that throws would have named another
  }
}

BOOST_AUTO_TEST_CASE(a_reference_that_diverges_is_told_with_the_lowest_trajectory_and_the_step) {
  // Trajectory n starts at n/4 - 10 with velocity 1: in ten steps of 1/2 it passes the cliff if n >= 25.
  std::vector<phase_point<double, 1>> starts;
  for (int n = 0; n < 40; ++n) starts.push_back({vector<double, 1>(0.25 * n - 10.0), vector<double, 1>(1.0)});
  const auto make = [&](std::int64_t trajectories, int threads) {
    return make_flow_map_data(
        cliff(), listed<1>(starts), fine_steps<>(0.05),
        {.step = 0.5, .horizon = 5.0, .trajectories = trajectories, .threads = threads});
  };
  for (const int threads : {1, 2, 5}) {
    BOOST_TEST(refuses<std::runtime_error>([&] { make(40, threads); },
                                           {"trajectory 25 ", "srkn11b", "diverged at step 10: q1 is "}));
    BOOST_TEST(make(25, threads).pairs() == 250U);
  }
  // Whatever is thrown: of the starts that the list does not hold, the first.
  BOOST_TEST(refuses<std::out_of_range>(
      [&] {
        make_flow_map_data(cliff(), listed<1>({starts[0], starts[1]}), fine_steps<>(0.05),
                           {.step = 0.5, .trajectories = 40, .threads = 5});
      },
      {"number 3 of"}));
}

BOOST_AUTO_TEST_CASE(the_range_of_energies_is_that_of_all_starts_and_finishes) {
  const auto data = made({.step = 0.02, .horizon = 0.1, .trajectories = 20, .threads = 2});
  energy_range all;
  for (std::size_t n = 0; n < data.pairs(); ++n) {
    all.include(energy<double>(chain, data.start[n]));
    all.include(energy<double>(chain, data.finish[n]));
  }
  BOOST_REQUIRE(data.energies.has_value());
  BOOST_TEST(data.energies->low == all.low);
  BOOST_TEST(data.energies->high == all.high);
  BOOST_TEST(all.low < all.high);
  const listed<1> at_rest({{vector<double, 1>(0.0), vector<double, 1>(0.0)}});
  const auto without =
      make_flow_map_data(cliff(), at_rest, fine_steps<>(0.05), {.step = 0.5, .trajectories = 1});
  BOOST_TEST(!without.energies.has_value());  // a force alone has no energy
}

BOOST_AUTO_TEST_CASE(trajectories_may_begin_with_any_number) {
  const data_options options{.step = 0.02, .horizon = 0.1, .trajectories = 21};
  const auto all = made(options);
  auto later = options;
  later.first = 5;
  later.trajectories = 16;
  const auto rest = made(later);
  BOOST_REQUIRE(rest.pairs() == 80U);
  for (std::size_t n = 0; n < rest.pairs(); ++n) {
    BOOST_TEST(same_bits(rest.start[n], all.start[n + 25]));
    BOOST_TEST(same_bits(rest.finish[n], all.finish[n + 25]));
  }
  BOOST_TEST(!same_bits(rest.start[0], all.start[0]));
  later.first = -1;
  BOOST_TEST(refuses<wrong>([&] { made(later); }, {"number -1"}));
}

BOOST_AUTO_TEST_CASE(a_pair_knows_its_trajectory) {
  flow_map_data data;
  data.first_of = {0, 2, 2, 5};
  BOOST_TEST(data.trajectory_of(0) == 0U);
  BOOST_TEST(data.trajectory_of(1) == 0U);
  BOOST_TEST(data.trajectory_of(2) == 2U);  // the one between holds no pair
  BOOST_TEST(data.trajectory_of(4) == 2U);
}

// 21 trajectories fill no number of lanes.
BOOST_AUTO_TEST_CASE(the_number_of_lanes_changes_no_bit) {
  const auto of = [](const auto& system) {
    const data_options options{.step = 0.02, .horizon = 0.1, .trajectories = 21, .threads = 2};
    return make_flow_map_data(system, law, fine_steps<>(1e-3), options);
  };
  const auto one = of(in_lanes<fpu_chain<3>, 1>(chain));
  BOOST_TEST(same_bits(one, of(chain)));
  BOOST_TEST(same_bits(one, of(in_lanes<fpu_chain<3>, 3>(chain))));
  BOOST_TEST(!same_bits(one, made({.step = 0.02, .horizon = 0.1, .trajectories = 21, .seed = 2})));
}

BOOST_AUTO_TEST_CASE(progress_counts_to_the_number_of_trajectories) {
  for (const int threads : {1, 3}) {
    std::mutex guard;
    std::vector<std::int64_t> told;
    made({.step = 0.02,
          .horizon = 0.02,
          .trajectories = 30,
          .threads = threads,
          .progress = [&](std::int64_t done) {
            const std::lock_guard lock(guard);
            told.push_back(done);
          }});
    std::sort(told.begin(), told.end());  // several threads tell in any order
    BOOST_REQUIRE(!told.empty());
    BOOST_TEST(told.back() == 30);
    for (std::size_t n = 1; n < told.size(); ++n) BOOST_TEST(told[n - 1] < told[n]);
  }
}
