// SPDX-License-Identifier: BSL-1.0
// A fit says whether it may be used, and if not, why. What cannot be learned at all is refused. Which
// classical methods a fit is compared with, at which steps, and by which statistic.
#include "../../src/nysalt/learning/describe.hpp"
#include "../../src/nysalt/learning/strongest_rival.hpp"
#include "../support/learned.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
constexpr int dynamic = Eigen::Dynamic;
const fpu_chain<3> chain(50.0);
const linear_chain oscillator(Eigen::MatrixXd::Constant(1, 1, 4.0));  // frequency 2
const family two_stages{nystrom()};

data_sets of_chain(const auto& reference, double step) {
  return {chain, fpu_law<3>(chain), reference, {.step = step, .horizon = 20.0 * step, .trajectories = 50}};
}
flow_map_data of_oscillator(double step, const auto& reference) {
  const auto number = [](double x) { return Eigen::VectorXd::Constant(1, x); };
  const listed<dynamic> two_states({{number(0.5), number(0.0)}, {number(0.0), number(1.0)}});
  return make_flow_map_data(oscillator, two_states, reference,
                            {.step = step, .horizon = step, .trajectories = 2});
}
flow_map_data of_oscillator(double step) { return of_oscillator(step, exact_linear(oscillator)); }
fit fit_oscillator(double step, const fit_options& options = {}) {
  const auto data = of_oscillator(step);
  return learn(two_stages, oscillator, data, data, options);
}

using F = fit_summary;

/// A fit in two coordinates, sound but for these members and their values.
F fit_with() {
  F sound;
  sound.step = 0.1;
  sound.coordinates_used = 2;
  sound.one_step_error = 1e-3;
  sound.loss_name = "state:1";
  sound.held_out_start_loss = 1.00e-6;
  sound.held_out_loss = 0.50e-6;
  sound.held_out_noise = 0.0;
  sound.reference_checked = true;
  sound.reference_error = 1e-5;
  return sound;
}
F fit_with(auto member, auto value, auto... more) {
  F fit = fit_with(more...);
  fit.*member = value;
  return fit;
}

const method& method_named(const std::string& name) {
  static const auto all = classical_methods();
  return *std::ranges::find(all, name, &method::name);
}

const henon_heiles galaxy;
data_sets of_galaxy(const auto& reference, double step, int steps = 10, std::int64_t trajectories = 50) {
  return {galaxy,
          around_rest<2>(0.1, 0.1),
          reference,
          {.step = step, .horizon = steps * step, .trajectories = trajectories}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_objection_has_its_sentence_and_a_sound_fit_none) {
  using detail::objection;
  BOOST_TEST(objection(fit_with(), true, "") == "");
  BOOST_TEST(objection(fit_with(), false, "") == "the search did not converge");
  for (const bool settled : {false, true})
    BOOST_TEST(objection(fit_with(), settled, "it diverges") == "it diverges");
  const auto not_moving = [](const std::string& loss) {
    return "its held-out one-step loss " + loss + " is no better than that of not moving at all";
  };
  BOOST_TEST(objection(fit_with(&F::one_step_error, 7.0), true, "it diverges") ==
             not_moving("4.90e+01"));  // the first
  const std::string ran_away = "a parameter ran away to the end of its range: the data do not determine it";
  const std::string worse = "on held-out data it is worse than the parameters that the search began with";
  const auto rough = [](const std::string& error) {
    return "the reference's own error " + error + " is not small against the one-step error 1.00e-03";
  };
  const std::vector<std::pair<F, std::string>> rows{
      // Not to move has the loss 1 in each of two coordinates; a proposal may turn by more than half a
      // period.
      {fit_with(&F::one_step_error, std::sqrt(2.0)), not_moving("2.00e+00")},
      {fit_with(&F::one_step_error, 7.0), not_moving("4.90e+01")},
      {fit_with(&F::one_step_error, not_a_number), not_moving("nan")},
      {fit_with(&F::one_step_error, 1.414), ""},
      {fit_with(&F::one_step_error, 7.0, &F::loss_name, "acceptance"), ""},
      {fit_with(&F::is_at_no_bound, false), ran_away},
      {fit_with(&F::is_at_no_bound, false, &F::is_of_data, false), ran_away},
      {fit_with(&F::held_out_loss, 2e-6), worse},
      {fit_with(&F::held_out_loss, not_a_number), worse},
      {fit_with(&F::held_out_loss, 2e-6, &F::is_of_data, false), ""},  // the data only judge
      {fit_with(&F::held_out_loss, 2e-6, &F::is_held_by_guard, true), ""},
      {fit_with(&F::held_out_loss, 2e-6, &F::held_out_start_loss, infinite), ""},
      {fit_with(&F::held_out_loss, 1e-24, &F::held_out_start_loss, 1e-26), ""},  // rounding
      // Worse, but no more than chance allows.
      {fit_with(&F::held_out_loss, 1.05e-6), worse},
      {fit_with(&F::held_out_loss, 1.05e-6, &F::held_out_noise, 0.016e-6), worse},
      {fit_with(&F::held_out_loss, 1.05e-6, &F::held_out_noise, 0.017e-6), ""},  // three of these make .051
      {fit_with(&F::held_out_loss, 1.51e-6, &F::held_out_noise, 1.0e-6), worse},
      {fit_with(&F::reference_error, 1.01e-5), rough("1.01e-05")},
      {fit_with(&F::reference_error, not_a_number), rough("nan")},
      {fit_with(&F::reference_error, 1.0, &F::reference_checked, false), ""}};
  for (const auto& [fit, sentence] : rows) BOOST_TEST(objection(fit, true, "") == sentence);
}

BOOST_AUTO_TEST_CASE(the_noise_is_that_of_paired_differences) {
  // Differences 1, 2, 3: their sum scatters by sqrt(3) times their deviation, 1.
  const std::vector<double> b{10.0, 200.0, 3000.0};
  const std::vector<double> a{11.0, 202.0, 3003.0};
  BOOST_TEST(std::abs(detail::noise_of_difference(a, b, shard(3)) - std::sqrt(3.0)) < 1e-15);
  BOOST_TEST(detail::noise_of_difference(b, b, shard(3)) == 0.0);
  BOOST_TEST(std::isinf(detail::noise_of_difference({1.0}, {2.0}, shard(1))));  // of one nothing is known
}

// Verlet at a tenth of the step errs by a hundredth of its error at the step itself, which is a tenth of what
// the learned method errs by: enough to move the optimum by more than its standard error.
BOOST_AUTO_TEST_CASE(a_reference_with_an_error_of_its_own_is_flagged) {
  const auto fit = of_chain(fine_steps(1e-4, verlet()), 1e-3).learned(two_stages, chain);
  const auto right = of_chain(fine_steps(1e-3), 1e-3).learned(two_stages, chain);
  BOOST_TEST_CONTEXT(fit.summary.full() << right.summary.full()) {
    BOOST_TEST(!fit.summary.usable);
    BOOST_TEST(says(fit.summary.reason, "the reference's own error"));
    BOOST_TEST(right.summary.usable);
    BOOST_TEST(right.summary.reason.empty());
    BOOST_TEST(!says(right.summary.full(), "not measured"));
    BOOST_TEST(std::abs(fit.theta[1] - right.theta[1] - 1e-3) < 0.5e-3);  // known to one digit
  }
}

// However early the search ends there is an answer within the ranges; and it is flagged unless it is good.
BOOST_AUTO_TEST_CASE(a_search_that_is_cut_short_is_flagged) {
  const auto enough = fit_oscillator(0.5).summary;
  BOOST_TEST_CONTEXT(enough.full()) BOOST_TEST(enough.usable);
  int flagged = 0;
  for (const int iterations : {0, 1, 3}) {
    for (const double b1 : {1e-3, 0.3, 0.7, 0.999}) {
      for (const double beta1 : {0.0, 0.1, 0.5}) {
        const auto fit = fit_oscillator(
            0.5, {.start = Eigen::Vector2d(b1, beta1), .random_starts = 0, .max_iterations = iterations});
        BOOST_TEST_CONTEXT("from " << b1 << ", " << beta1 << " in " << iterations << "\n"
                                   << fit.summary.full()) {
          BOOST_TEST(two_stages.is_in_range(fit.theta));
          BOOST_TEST((fit.summary.loss <= 1.01 * enough.loss || !fit.summary.usable));
        }
        flagged += says(fit.summary.reason, "did not converge");
      }
    }
  }
  BOOST_TEST(flagged > 0);
}

BOOST_AUTO_TEST_CASE(what_does_not_hold_on_held_out_data_is_flagged) {
  const auto other_map = of_oscillator(0.5, fine_steps(0.5, member(nystrom(), {0.4, 0.45})));
  const auto fit =
      learn(two_stages, oscillator, other_map, of_oscillator(0.5), {.loss = loss_named("state:1")});
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    BOOST_TEST(!fit.summary.usable);
    BOOST_TEST(says(fit.summary.reason, "on held-out data it is worse"));
  }
}

BOOST_AUTO_TEST_CASE(the_summary_tells_when_held_out_data_are_not_new_and_what_was_not_checked) {
  auto sets = of_chain(fine_steps(1e-3), 0.01);
  const auto same = learn(two_stages, chain, sets.data, sets.data).summary;
  sets.data.finer.clear();
  const auto fresh = sets.learned(two_stages, chain).summary;
  BOOST_TEST(says(same.full(), "these are the data learned from"));
  BOOST_TEST(says(same.brief(), "the same data"));
  BOOST_TEST(!says(fresh.full(), "these are the data learned from"));
  BOOST_TEST(says(fresh.full(), "seed 1, held out 2"));
  BOOST_TEST(says(fresh.full(), "declared bands [0, "));
  BOOST_TEST(says(fresh.full(), "the reference's own not measured"));
}

BOOST_AUTO_TEST_CASE(the_summary_tells_parameters_in_full_and_the_reason) {
  for (const double step : {0.5, 1.4}) {
    const auto fit = fit_oscillator(step, {.coordinates = coordinates::energy, .guarded = false}).summary;
    BOOST_TEST_CONTEXT(fit.full()) {
      for (const auto& p : fit.parameters) {
        BOOST_TEST(says(fit.full(), fmt::format("{:.17g}", p.value)));
        BOOST_TEST(says(fit.brief(), fmt::format("{} = {:.6f}", p.name, p.value)));
      }
      BOOST_TEST(fit.usable == (step < 1.0));
      BOOST_TEST(says(fit.full(), fit.usable ? "yes" : "no: " + fit.reason));
      BOOST_TEST(says(fit.brief(), ", " + fit.verdict_in_words()));
      BOOST_TEST((fit.usable || says(fit.brief(), "NOT usable: " + fit.reason)));
    }
  }
}

// Where a formula is as good, the summary names it. More in long/learning/verdict_test.
BOOST_AUTO_TEST_CASE(where_learning_gains_nothing_the_classical_method_is_named) {
  const fit_options options{.loss = loss_named("state:1"), .random_starts = 2, .planned_steps = 5000};
  // Data that a classical method made are fitted by itself.
  auto by_mclachlan = of_galaxy(fine_steps(0.5, mclachlan2{}), 0.5);
  by_mclachlan.data.finer.clear();  // half the step is another map
  by_mclachlan.held_out.finer.clear();
  const auto own = by_mclachlan.learned(two_stages, galaxy, options).summary;
  // At a large step learning gains.
  const auto large = of_galaxy(fine_steps(0.02), 0.8).learned(family(fg_chin()), galaxy, options).summary;
  BOOST_TEST_CONTEXT(own.full() << large.full()) {
    BOOST_TEST((own.verdict() == verdict::nothing_gained));
    BOOST_TEST(own.rival == "mclachlan2");
    BOOST_TEST(own.rival_step == 0.5);
    BOOST_TEST(own.usable);
    BOOST_TEST(says(own.brief(), "nothing gained over mclachlan2: take mclachlan2 at step 0.5"));
    BOOST_TEST((large.verdict() == verdict::usable));
    BOOST_TEST(large.gain() > 1.0);
    BOOST_TEST(says(large.full(), "judgement"));
  }
}

BOOST_AUTO_TEST_CASE(coordinates_without_motion_are_named_and_the_fit_goes_on) {
  const linear_chain with_a_free_mass(Eigen::Vector2d(4.0, 0.0).asDiagonal());
  const listed<dynamic> starts({{Eigen::Vector2d(0.5, 1.0), Eigen::Vector2d(0.0, 0.0)},
                                {Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(1.0, 0.0)}});
  const auto data = make_flow_map_data(with_a_free_mass, starts, exact_linear(with_a_free_mass),
                                       {.step = 0.5, .horizon = 0.5, .trajectories = 2});
  const auto fit = learn(two_stages, with_a_free_mass, data, data, {.loss = loss_named("state:1")});
  const auto alone = fit_oscillator(0.5);
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    BOOST_TEST(fit.summary.usable);
    BOOST_TEST(fit.summary.dropped == (std::vector<std::string>{"q2", "p2"}), per_element());
    BOOST_TEST(says(fit.summary.full(), "q2, left out of the loss"));
    // Newton's steps end at rounding, magnified by the curvature's condition.
    BOOST_TEST((fit.theta - alone.theta).cwiseAbs().maxCoeff() <= 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_learned_is_refused_with_the_reason) {
  const auto data = of_oscillator(0.5);
  const linear_chain other(Eigen::MatrixXd::Constant(1, 1, 9.0));
  const listed<dynamic> at_rest({{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)}});
  const auto nothing =
      make_flow_map_data(oscillator, at_rest, exact_linear(oscillator), {.step = 0.5, .trajectories = 1});
  const auto refused = [&](const flow_map_data& training, const flow_map_data& held_out, said words) {
    return refuses([&] { learn(two_stages, oscillator, training, held_out); }, words);
  };
  BOOST_TEST(refuses([&] { learn(two_stages, other, data, data); },
                     {"the data must be of", describe(oscillator), describe(other)}));
  BOOST_TEST(refused(data, of_oscillator(0.25), {"same step", "0.5 and 0.25"}));
  BOOST_TEST(refused(nothing, nothing, {"must hold motion"}));
  const std::vector<std::pair<fit_options, std::vector<std::string>>> impossible{
      {{.start = Eigen::Vector2d(1.2, 0.4)}, {"nystrom", "b1", "(0, 1)", "1.2"}},
      {{.start = Eigen::Vector2d(0.5, 0.6)}, {"beta1", "[0, 0.5]", "0.6"}},
      {{.start = Eigen::VectorXd::Constant(3, 0.1)}, {"nystrom", "must be 2"}},
      {{.fixed = {std::nullopt, -0.1}}, {"beta1", "-0.1"}},
      {{.fixed = {0.1, 0.2, 0.3}}, {"nystrom", "must be 2"}},
      {{.random_starts = -1}, {"random_starts", "-1"}},
      {{.max_iterations = -3}, {"max_iterations", "-3"}},
      {{.loss = loss_named("state:6")}, {"6 steps", "longer horizon"}},
      {{.loss = loss_named("covariance")}, {"covariance", describe(oscillator)}}};
  for (const auto& [options, words] : impossible) {
    BOOST_CHECK_EXCEPTION(
        learn(two_stages, oscillator, data, data, options), wrong, [&all = words](const wrong& said) {
          return std::ranges::all_of(all, [&](const auto& word) { return says(said.what(), word); });
        });
  }
}

BOOST_AUTO_TEST_CASE(progress_counts_passes_and_may_end_the_search) {
  constexpr std::int64_t enough = 5;
  std::vector<std::int64_t> told;
  const auto count = [&](std::int64_t passes) {
    told.push_back(passes);
    if (passes + 1 == enough) throw std::runtime_error("enough");
  };
  BOOST_CHECK_THROW(fit_oscillator(0.5, {.execution = {.progress = count}}), std::runtime_error);
  BOOST_TEST(told == (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
}

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
  constexpr double step = 0.2;
  const data_sets sets = of_galaxy(fine_steps(0.1 * step), step, 7, 6);
  const learning_problem problem(two_stages, galaxy, sets.data, sets.held_out,
                                 {.loss = loss_named("state:1")});
  const Eigen::VectorXd theta = two_stages.starts.front().theta;
  detail::held_out_by_times held_out(problem);
  const auto rival_of = [&](const method& method) {
    return detail::rival_of(problem, held_out, method, theta);
  };
  const nysalt::method& method = method_named("forest_ruth");
  const auto rival = rival_of(method);
  BOOST_REQUIRE(rival.has_value());
  BOOST_TEST(rival->name == "forest_ruth");
  BOOST_TEST(std::abs(rival->step - 1.5 * step) < 1e-15);
  const nysalt::method member("member", two_stages.letters, two_stages.coefficients(theta),
                              {2, false, false});
  const metric measure(model(galaxy), sets.data, coordinates::qp);
  // Of the two windows of three steps that seven steps have.
  const auto by_hand = [&](const nysalt::method& stepped, double h, int steps) {
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
  BOOST_TEST(agree(rival->losses, by_hand(method, 1.5 * step, 2)));
  BOOST_TEST(agree(rival->losses_beside, by_hand(member, step, 3)));
  BOOST_TEST(!agree(rival->losses, by_hand(method, step, 2)));
  BOOST_TEST(!agree(rival->losses_beside, by_hand(member, step, 2)));
  BOOST_TEST(rival->judged_step == 1.5 * step);
  // Where the steps divide all times are shared; eleven evaluations have no time in so short trajectories.
  BOOST_TEST(rival_of(method_named("verlet"))->losses_beside.empty());
  BOOST_TEST(rival_of(method_named("verlet"))->step == 0.5 * step);
  BOOST_TEST(!rival_of(method_named("srkn11b")).has_value());
  BOOST_TEST(!rival_of(method_named("fg4_processed")).has_value());
}

BOOST_AUTO_TEST_CASE(who_errs_less_and_fails_the_trial_is_said_too) {
  const std::vector<double> own{1e-3, 2e-3, 1.5e-3, 1e-3, 3e-3, 2e-3, 1e-3, 4e-3, 1e-3, 2e-3};
  const shard ten(10);
  const auto contender_of = [&](const std::string& name, double step, double factor) {
    detail::contender result{.name = name, .losses = own, .method = method_named(name), .step = step};
    for (double& loss : result.losses) loss *= factor;
    result.loss = ten.sum(result.losses);
    return result;
  };
  const auto with = [&](double of_chin, double of_verlet, bool fails) {
    const auto objection = [&](const detail::contender& one) {
      return one.name == "chin4a" && fails ? std::string("unstable: 8 of 9 trajectories are lost") : "";
    };
    fit_summary summary = fit_with(&F::usable, true);
    summary.held_out_loss = ten.sum(own);
    detail::summarise_rival(contender_of("mclachlan2", 0.0, 1.0),
                            {contender_of("verlet", 0.25, of_verlet), contender_of("chin4a", 0.75, of_chin)},
                            ten, objection, summary);
    return summary;
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
