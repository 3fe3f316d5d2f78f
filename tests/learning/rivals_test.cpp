// SPDX-License-Identifier: BSL-1.0
// Which classical methods a fit is compared with, at which steps, and by which statistic.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "../support/learned.hpp"
#include "nysalt/learning/make_problem.hpp"
#include "nysalt/learning/objection.hpp"
#include "nysalt/methods/classical_methods.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const run_time_family two_stages{nystrom()};

const tabulated& method_named(const std::string& name) {
  static const auto all = classical_methods();
  return *std::ranges::find(all, name, &tabulated::name);
}

/// Of a small galaxy.
data_sets of_steps(double step, int steps, std::int64_t trajectories) {
  return {henon_heiles(),
          around_rest<2>(0.1, 0.1),
          fine_steps<>(step / 10.0),
          {.step = step, .horizon = steps * step, .trajectories = trajectories}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(contenders_are_compared_by_means_and_by_ranks) {
  const shard five(5);
  const std::vector<double> rising{1.0, 2.0, 4.0, 8.0, 16.0};
  std::vector<double> less = rising;
  for (std::size_t m = 0; m < 5; ++m) less[m] /= 2.0 + static_cast<double>(m);  // ratios all differ
  // All 15 of the ranks, of which 7.5 are expected, with the variance 5 * 6 * 11/24.
  BOOST_TEST(std::abs(detail::signed_rank(less, rising, five) - 7.5 / std::sqrt(13.75)) < 1e-12);
  BOOST_TEST(detail::signed_rank(rising, less, five) == -detail::signed_rank(less, rising, five));
  BOOST_TEST(detail::signed_rank(rising, rising, five) == 0.0);
  // Five of one sign are chance in 3 %, seven in less than half of 2.3 %.
  BOOST_TEST(!detail::is_better({1.0, 1.1, 1.2, 1.3, 1.4}, {1e3, 1.2, 1.4, 1.6, 1.8}, five));
  BOOST_TEST(
      detail::is_better({1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6}, {1e3, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2}, shard(7)));
  // A tail: the half on each trajectory, which the mean does not see for the largest one's sake.
  constexpr std::size_t count = 100;
  const shard all(count);
  std::vector<double> tail;
  for (std::size_t m = 0; m < count; ++m) tail.push_back(std::pow(10.0, static_cast<double>(m % 7) - 3.0));
  tail[50] = 1e6;
  std::vector<double> half = tail;
  for (double& x : half) x /= 2.0;
  const double noise = detail::noise_of_difference(half, tail, all);
  BOOST_TEST(all.sum(tail) - all.sum(half) < 2.0 * noise);
  BOOST_TEST(detail::is_better(half, tail, all));
  BOOST_TEST(!detail::is_better(tail, half, all));
  // As often more as less, on the whole less: chance.
  std::vector<double> mixed = tail;
  for (std::size_t m = 0; m < count; ++m) mixed[m] *= m % 2 == 0 ? 0.5 : 2.0;
  BOOST_TEST(all.sum(mixed) < all.sum(tail));
  BOOST_TEST(!detail::is_better(mixed, tail, all));
  // What a few lose, most do not show: ten of a hundred are seen in the mean, one is not.
  std::vector<double> steady;
  for (std::size_t m = 0; m < count; ++m) steady.push_back(m % 2 == 0 ? 1.0 : 1.01);
  std::vector<double> losing;
  for (std::size_t m = 0; m < count; ++m) losing.push_back(m % 2 == 0 ? 1.01 : 1.0);
  losing[3] = 1e4;
  BOOST_TEST(!detail::is_better(steady, losing, all));
  for (std::size_t m = 0; m < 10; ++m) losing[10 * m] = 1e4;
  BOOST_TEST(std::abs(detail::signed_rank(steady, losing, all)) < 2.28);
  BOOST_TEST(detail::is_better(steady, losing, all));
}

// Three steps of two evaluations cost as much as two of three, and last as long: there both are compared.
BOOST_AUTO_TEST_CASE(rivals_of_any_cost_are_compared_at_the_times_that_both_have) {
  const henon_heiles galaxy;
  constexpr double step = 0.2;
  const data_sets sets = of_steps(step, 7, 6);
  const auto problem =
      make_learning_problem(two_stages, galaxy, sets.data, sets.held_out, {.loss = loss_named("state:1")});
  const tabulated& method = method_named("forest_ruth");
  const auto rival = problem.rival(method);
  BOOST_REQUIRE(rival.has_value());
  BOOST_TEST(rival->name == "forest_ruth");
  BOOST_TEST(std::abs(rival->step - 1.5 * step) < 1e-15);
  BOOST_TEST_REQUIRE(static_cast<bool>(rival->losses_beside));
  const Eigen::VectorXd theta = two_stages.starts.front().theta;
  const tabulated member("member", two_stages.letters, two_stages.coefficients(theta), {2, false, false});
  const metric measure(model(galaxy), sets.data, coordinates::qp);
  // Of the two windows of three steps that seven steps have.
  const auto by_hand = [&](const tabulated& stepped, double h, int steps) {
    std::vector<double> result;
    for (std::size_t m = 0; m < 6; ++m) {
      double sum = 0.0;
      for (std::size_t n = 0; n < 2; ++n) {
        const std::size_t first = sets.held_out.first_of[m] + 3 * n;
        const auto start = sets.held_out.start[first];
        phase_point<double, 2> x{start.q, start.p};
        const auto stepper = make_stepper(galaxy, stepped, h);
        for (int k = 0; k < steps; ++k) stepper.step(x);
        Eigen::VectorXd r(measure.residuals());
        measure.residual(Eigen::VectorXd(x.q), Eigen::VectorXd(x.p), sets.held_out.finish[first + 2],
                         r.data());
        sum += r.squaredNorm();
      }
      result.push_back(sum / 12.0);
    }
    return result;
  };
  const auto agree = [](const std::vector<double>& a, const std::vector<double>& b) {
    double off = a.size() == b.size() ? 0.0 : 1.0;
    for (std::size_t m = 0; m < b.size(); ++m) off = std::max(off, std::abs(a[m] / b[m] - 1.0));
    return off < 1e-6;
  };
  BOOST_TEST(agree(rival->held_out_losses, by_hand(method, 1.5 * step, 2)));
  BOOST_TEST(agree(rival->losses_beside(theta), by_hand(member, step, 3)));
  BOOST_TEST(!agree(rival->held_out_losses, by_hand(method, step, 2)));
  BOOST_TEST(!agree(rival->losses_beside(theta), by_hand(member, step, 2)));
  BOOST_TEST(rival->judged_step == 1.5 * step);
  // Where the steps divide all times are shared; eleven evaluations have no time in so short trajectories.
  BOOST_TEST(!problem.rival(method_named("verlet"))->losses_beside);
  BOOST_TEST(problem.rival(method_named("verlet"))->step == 0.5 * step);
  BOOST_TEST(!problem.rival(method_named("srkn11b")).has_value());
  BOOST_TEST(!problem.rival(method_named("fg4_processed")).has_value());
}

// On a motion without fast parts methods of higher order win, which take three, four or five evaluations.
BOOST_AUTO_TEST_CASE(a_rival_of_another_number_of_evaluations_can_win) {
  const henon_heiles galaxy;
  constexpr double step = 0.4;
  const auto sets = of_steps(step, 12, 40);
  const auto found = sets.learned(two_stages, galaxy, {.random_starts = 2, .planned_steps = 5000}).summary;
  BOOST_TEST_CONTEXT(found.full()) {
    BOOST_REQUIRE(found.rival_step > 0.0);
    BOOST_TEST(method_named(found.rival).letters().evaluations_per_step % 2 == 1);
    BOOST_TEST(found.rival_step > step);
    BOOST_TEST(found.loss_beside_rival != found.held_out_loss);
    BOOST_TEST(says(found.full(), " by times that both have"));
  }
}

BOOST_AUTO_TEST_CASE(who_errs_less_and_fails_the_trial_is_said_too) {
  const henon_heiles galaxy;
  const data_sets sets = of_steps(0.5, 10, 20);
  auto problem =
      make_learning_problem(two_stages, galaxy, sets.data, sets.held_out,
                            {.loss = loss_named("state:1"), .random_starts = 2, .planned_steps = 5000});
  problem.rival = [](const tabulated&) { return std::optional<rival_method>(); };
  const fit alone = solve(problem);
  const std::vector<double> own = problem.held_out_losses(alone.theta);
  const auto with = [&](double of_chin, double of_verlet, bool fails) {
    problem.rival = [=](const tabulated& method) -> std::optional<rival_method> {
      const bool is_chin = method.name() == "chin4a";
      if (!is_chin && method.name() != "verlet") return std::nullopt;
      const double h = is_chin ? 0.75 : 0.25;
      rival_method planted{
          .name = method.name(), .step = h, .held_out_losses = own, .method = method, .judged_step = h};
      for (double& loss : planted.held_out_losses) loss *= is_chin ? of_chin : of_verlet;
      return planted;
    };
    problem.judged = [=](const tabulated& method, double h) {
      judgement found;
      found.step = h;
      found.verdict = step_verdict::good;
      if (method.name() != "chin4a" || !fails) return found;
      found.verdict = step_verdict::unstable;
      found.reason = "8 of 9 trajectories are lost in 20000 steps, the first at step 2148";
      return found;
    };
    return solve(problem).summary;
  };
  const fit_summary both = with(0.01, 0.64, true);
  BOOST_TEST_CONTEXT(both.full()) {
    BOOST_TEST(both.rival == "verlet");
    BOOST_TEST(both.gains_nothing);
    BOOST_TEST(both.failing_rival.name == "chin4a");
    BOOST_TEST(std::abs(both.failing_rival.times_less - 8.0) < 1e-9);
    BOOST_TEST(
        says(both.brief(),
             "take verlet at step 0.25; chin4a at step 0.75 errs 8 times less in the median, and fails: "
             "unstable: 8 of 9"));
    BOOST_TEST(says(both.full(), "at step 2148"));
  }
  const fit_summary sound = with(0.01, 0.64, false);
  BOOST_TEST(sound.rival == "chin4a");
  BOOST_TEST(sound.failing_rival.name == "");
  // Of those that the fit beats, whether they fail is not asked.
  const fit_summary beaten = with(2.0, 3.0, true);
  BOOST_TEST(beaten.rival == "chin4a");
  BOOST_TEST(!beaten.gains_nothing);
  BOOST_TEST(beaten.failing_rival.name == "");
}
