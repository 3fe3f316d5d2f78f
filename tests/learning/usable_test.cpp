// SPDX-License-Identifier: BSL-1.0
// A fit says whether it may be used, and if not, why. What cannot be learned at all is refused.
#include <boost/test/unit_test.hpp>

#include "../support/learned.hpp"
#include "../support/refusal.hpp"
#include "nysalt/learning/objection.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
constexpr int dynamic = Eigen::Dynamic;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
const fpu_chain<3> chain(50.0);
const linear_chain oscillator(Eigen::MatrixXd::Constant(1, 1, 4.0));  // frequency 2
const run_time_family two_stages{nystrom()};

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

/// A fit in two coordinates, sound but for what a row says, and what is said of it.
struct a_fit {
  double one_step_error = 1e-3;
  std::string loss_name = "state:1";
  bool is_at_no_bound = true;
  bool is_of_data = true;
  bool is_held_by_guard = false;
  double held_out_start_loss = 1.00e-6;
  double held_out_loss = 0.50e-6;
  double held_out_noise = 0.0;
  bool reference_checked = true;
  double reference_error = 1e-5;

  std::string said(bool settled = true, const std::string& instability = "") const {
    fit_summary fit;
    fit.step = 0.1;
    fit.coordinates_used = 2;
    fit.one_step_error = one_step_error;
    fit.loss_name = loss_name;
    fit.is_at_no_bound = is_at_no_bound;
    fit.is_of_data = is_of_data;
    fit.is_held_by_guard = is_held_by_guard;
    fit.held_out_start_loss = held_out_start_loss;
    fit.held_out_loss = held_out_loss;
    fit.held_out_noise = held_out_noise;
    fit.reference_checked = reference_checked;
    fit.reference_error = reference_error;
    return detail::objection(fit, settled, instability);
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(every_objection_has_its_sentence_and_a_sound_fit_none) {
  BOOST_TEST(a_fit().said() == "");
  BOOST_TEST(a_fit().said(false) == "the search did not converge");
  BOOST_TEST(a_fit().said(false, "it diverges") == "it diverges");
  BOOST_TEST(a_fit().said(true, "it diverges") == "it diverges");
  const auto not_moving = [](const std::string& loss) {
    return "its held-out one-step loss " + loss + " is no better than that of not moving at all";
  };
  BOOST_TEST(a_fit{.one_step_error = 7.0}.said(true, "it diverges") == not_moving("4.90e+01"));  // the first
  const std::string ran_away = "a parameter ran away to the end of its range: the data do not determine it";
  const std::string worse = "on held-out data it is worse than the parameters that the search began with";
  const auto rough = [](const std::string& error) {
    return "the reference's own error " + error + " is not small against the one-step error 1.00e-03";
  };
  const std::vector<std::pair<a_fit, std::string>> rows{
      // Not to move has the loss 1 in each of two coordinates; a proposal may turn by more than half a
      // period.
      {{.one_step_error = std::sqrt(2.0)}, not_moving("2.00e+00")},
      {{.one_step_error = 7.0}, not_moving("4.90e+01")},
      {{.one_step_error = not_a_number}, not_moving("nan")},
      {{.one_step_error = 1.414}, ""},
      {{.one_step_error = 7.0, .loss_name = "acceptance"}, ""},
      {{.is_at_no_bound = false}, ran_away},
      {{.is_at_no_bound = false, .is_of_data = false}, ran_away},
      {{.held_out_loss = 2e-6}, worse},
      {{.held_out_loss = not_a_number}, worse},
      {{.is_of_data = false, .held_out_loss = 2e-6}, ""},  // the data only judge
      {{.is_held_by_guard = true, .held_out_loss = 2e-6}, ""},
      {{.held_out_start_loss = infinite, .held_out_loss = 2e-6}, ""},
      {{.held_out_start_loss = 1e-26, .held_out_loss = 1e-24}, ""},  // rounding
      // Worse, but no more than chance allows.
      {{.held_out_loss = 1.05e-6}, worse},
      {{.held_out_loss = 1.05e-6, .held_out_noise = 0.016e-6}, worse},
      {{.held_out_loss = 1.05e-6, .held_out_noise = 0.017e-6}, ""},  // three of these make .051
      {{.held_out_loss = 1.51e-6, .held_out_noise = 1.0e-6}, worse},
      {{.reference_error = 1.01e-5}, rough("1.01e-05")},
      {{.reference_error = not_a_number}, rough("nan")},
      {{.reference_checked = false, .reference_error = 1.0}, ""}};
  for (const auto& [fit, sentence] : rows) BOOST_TEST(fit.said() == sentence);
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
  const auto fit = of_chain(fine_steps<verlet>(1e-4), 1e-3).learned(two_stages, chain);
  const auto right = of_chain(fine_steps<>(1e-3), 1e-3).learned(two_stages, chain);
  BOOST_TEST_CONTEXT(fit.summary.full() << right.summary.full()) {
    BOOST_TEST(!fit.summary.usable);
    BOOST_TEST(says(fit.summary.reason, "the reference's own error"));
    BOOST_TEST(right.summary.usable);
    BOOST_TEST(right.summary.reason.empty());
    BOOST_TEST(!says(right.summary.full(), "not measured"));
    BOOST_TEST(std::abs(fit.theta[1] - right.theta[1] - 1e-3) < 0.5e-3);  // known to one digit
  }
}

BOOST_AUTO_TEST_CASE(an_optimum_that_is_unstable_on_the_systems_frequencies_is_flagged) {
  const phase_point<double, dynamic> start{Eigen::VectorXd::Ones(1), Eigen::VectorXd::Zero(1)};
  const auto diverges = [&](const fit& found) {
    const tabulated method("found", two_stages.letters, two_stages.coefficients(found.theta), {});
    return integrate(oscillator, method, found.summary.step, start, 10000).diverged_at.has_value();
  };
  const auto stable = fit_oscillator(1.25, {.coordinates = coordinates::energy});
  // z = 2.8, where the start is unstable too; the guard has a most stable member there, and without it the
  // optimum is found.
  const auto guarded = fit_oscillator(1.4, {.coordinates = coordinates::energy});
  const auto unstable = fit_oscillator(1.4, {.coordinates = coordinates::energy, .guarded = false});
  BOOST_TEST_CONTEXT(stable.summary.full() << guarded.summary.full() << unstable.summary.full()) {
    BOOST_TEST(guarded.summary.is_held_by_guard);
    BOOST_TEST(!diverges(guarded));
    BOOST_TEST(stable.summary.usable);
    BOOST_TEST(!diverges(stable));
    BOOST_TEST(!unstable.summary.usable);
    BOOST_TEST(says(unstable.summary.reason, "unstable: "));
    BOOST_TEST(says(unstable.summary.judgement.linear_objection, "it is not linearly stable at z = 2.8"));
    BOOST_TEST(
        says(unstable.summary.judgement.linear_objection, "1.96 to 2.04"));  // 2, and 2 % on either side
    BOOST_TEST(diverges(unstable));
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

BOOST_AUTO_TEST_CASE(what_does_not_hold_on_held_out_data_or_is_no_better_than_not_moving_is_flagged) {
  const auto other_map = of_oscillator(0.5, fine_steps(0.5, member<nystrom>({0.4, 0.45})));
  const auto fit =
      learn(two_stages, oscillator, other_map, of_oscillator(0.5), {.loss = loss_named("state:1")});
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    BOOST_TEST(!fit.summary.usable);
    BOOST_TEST(says(fit.summary.reason, "on held-out data it is worse"));
  }
  auto held_out = of_oscillator(0.5);
  for (auto x : held_out.start) x.q[0] = 1e200;  // finite, but its square is not
  const auto overflown = learn(two_stages, oscillator, of_oscillator(0.5), held_out);
  BOOST_TEST_CONTEXT(overflown.summary.full()) {
    BOOST_TEST(!std::isfinite(overflown.summary.held_out_loss));
    BOOST_TEST(!overflown.summary.usable);
  }
  // Half a period: the flow is q -> -q, p -> -p, and no member of the family comes near it.
  const auto half_a_period = fit_oscillator(1.55, {.fixed = {0.5, 0.0}}).summary;  // z = 3.1
  BOOST_TEST_CONTEXT(half_a_period.full()) {
    BOOST_TEST(half_a_period.held_out_loss >= 2.0);  // what not moving has in two coordinates
    BOOST_TEST(!half_a_period.usable);
    BOOST_TEST(says(half_a_period.reason, "not moving"));
  }
}

BOOST_AUTO_TEST_CASE(the_summary_tells_when_held_out_data_are_not_new_and_what_was_not_checked) {
  auto sets = of_chain(fine_steps<>(1e-3), 0.01);
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
  const henon_heiles galaxy;
  const fit_options options{.loss = loss_named("state:1"), .random_starts = 2, .planned_steps = 5000};
  const auto made_by = [&](const auto& reference, double step) {
    const data_options trajectories{.step = step, .horizon = 10.0 * step, .trajectories = 50};
    return data_sets(galaxy, around_rest<2>(0.1, 0.1), reference, trajectories);
  };
  // Data that a classical method made are fitted by itself.
  auto by_mclachlan = made_by(fine_steps(0.5, mclachlan2{}), 0.5);
  by_mclachlan.data.finer.clear();  // half the step is another map
  by_mclachlan.held_out.finer.clear();
  const auto own = by_mclachlan.learned(two_stages, galaxy, options).summary;
  // At a large step learning gains.
  const auto large =
      made_by(fine_steps<>(0.02), 0.8).learned(run_time_family(fg_chin()), galaxy, options).summary;
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
    BOOST_TEST(fit.summary.dropped == (std::vector<std::string>{"q2", "p2"}),
               boost::test_tools::per_element());
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
  const auto refused = [&](const flow_map_data& training, const flow_map_data& held_out,
                           std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { learn(two_stages, oscillator, training, held_out); }, words);
  };
  BOOST_TEST(refuses<wrong>([&] { learn(two_stages, other, data, data); },
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
    BOOST_CHECK_EXCEPTION(learn(two_stages, oscillator, data, data, options), wrong, [&](const wrong& said) {
      return std::ranges::all_of(words, [&](const auto& word) { return says(said.what(), word); });
    });
  }
}
