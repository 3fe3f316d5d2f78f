// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 10 s at -O0, 4.2 s at -O1.
// The search ends at the minimum: the member that made the data, wherever it lies, from wherever it starts.
// What a fit to whole trajectories has over a fit to one step, and how it is found.
#include "../../src/nysalt/learning/problem.hpp"
#include "../../src/nysalt/learning/starts_of_fit.hpp"
#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/learned.hpp"
#include "../support/members.hpp"
#include "../support/rounding.hpp"
#include "nysalt/learning/learn_enough.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const henon_heiles galaxy;
const family two_stages{nystrom()};
const family four_kicks{aba<4>()};

data_sets made_by(const auto& reference, double step, const normal_around<2>& starts,
                  std::uint64_t seed = 1) {
  return {galaxy, starts, reference, {.step = step, .horizon = 5.0 * step, .trajectories = 30, .seed = seed}};
}
const auto gentle_starts = around_rest<2>(0.06, 0.12);  // at step .5 none leaves
const auto starts = around_rest<2>(0.15, 0.2);

constexpr double h = 0.5;
const data_sets& exact_sets() {
  static const data_sets sets = made_by(fine_steps(h / 20.0), h, gentle_starts);
  return sets;
}

/// By the one-step loss, from the family's start alone.
fit fit_to(const data_sets& sets, fit_options options = {}) {
  options.loss = loss_named("state:1");
  options.random_starts = 0;
  if (!options.start) options.start = two_stages.starts.front().theta;
  return sets.learned(two_stages, galaxy, options);
}

/// How far theta can be off where the minimum is zero but for rounding: residuals of some 100 roundings, in
/// units of increments of `increment` or more, over the least singular value of the Jacobian.
double recovery_error(const data_sets& sets, const family& family, const Eigen::VectorXd& theta,
                      double increment) {
  const metric measure(galaxy, sets.data, coordinates::qp);
  const after_steps<> loss(family, galaxy, sets.data, state_error(measure));
  const symmetric_eigen of_loss(loss.at(theta).normal_matrix);
  return std::sqrt(4.0) * 100.0 * eps / increment / std::sqrt(of_loss.values[0]);
}

double distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return (a - b).cwiseAbs().maxCoeff(); }
Eigen::VectorXd pair(double b1, double beta1) { return Eigen::Vector2d(b1, beta1); }

/// The last Newton step of a parameter with the other one fixed.
double remaining_step(const data_sets& sets, const Eigen::VectorXd& theta, Eigen::Index free) {
  const metric measure(galaxy, sets.data, coordinates::qp);
  const after_steps<> loss(two_stages, galaxy, sets.data, state_error(measure));
  const curvature bend(hessian(detail::objective_of(loss), theta), {free});
  return std::abs(bend.solve(loss.at(theta).gradient())[free]);
}

template <Family F>
void check_recovery(double reach) {
  draws random;
  constexpr double step = 0.8;
  const nysalt::family family{F()};
  for (int n = 0; n < 2; ++n) {
    auto theta = F::start();
    for (double& x : theta) x += random.uniform(-reach, reach);
    const Eigen::VectorXd maker = column_of(theta);
    const auto sets = made_by(fine_steps(step, member_at(F(), theta)), step, starts);
    // The loss has other minima, of which some are very low: several starts find the one that is zero.
    for (const loss_choice& loss : {loss_choice{}, loss_named("state:3")}) {
      const auto found = sets.learned(family, galaxy, {.loss = loss, .random_starts = 4});
      const double allowed = recovery_error(sets, family, maker, 0.1);
      BOOST_TEST_CONTEXT(found.summary.full()) {
        BOOST_TEST(distance(found.theta, maker) <= allowed);
        BOOST_TEST(allowed <= 1e-8);  // which says something
        BOOST_TEST(found.summary.loss_name == loss.description());
      }
    }
    // Half the step is another map, and nothing in the family is it.
    const auto other = made_by(fine_steps(0.5 * step, member_at(F(), theta)), step, starts);
    const auto found = other.learned(family, galaxy, {.loss = loss_named("state:1")});
    BOOST_TEST(distance(found.theta, maker) > 1e-6);
  }
}

const fpu_chain<3> chain(50.0);

data_sets sets_at(double step) {
  return {
      chain, fpu_law<3>(chain), fine_steps(step / 180.0), {.step = step, .horizon = 8.0, .trajectories = 8}};
}

fit_summary fitted(const data_sets& sets, const family& family, const char* loss, fit_options options = {}) {
  options.loss = loss_named(loss);
  options.planned_steps = 2000;
  return sets.learned(family, chain, options).summary;
}

/// A slow oscillator, and a fast one of small amplitude.
struct two_speeds {
  static constexpr int dimension = 2;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    return q[0] * q[0] * 0.5 + q[1] * q[1] * 1250.0;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_member_that_made_the_data_is_recovered) {
  check_recovery<aba<4>>(0.03);
  check_recovery<fg4>(0.02);
}

BOOST_AUTO_TEST_CASE(an_optimum_beyond_the_bound_is_held_there_and_the_other_parameter_fitted_again) {
  const method maker("beyond the bound", two_stages.letters, two_stages.coefficients(pair(0.55, 0.53)),
                     {2, true, false});
  const auto sets = made_by(fine_steps(h, maker), h, gentle_starts);
  const auto fit = fit_to(sets);
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    BOOST_TEST(fit.theta[1] == 0.5);
    BOOST_TEST(!fit.summary.parameters[1].free);
    BOOST_TEST(fit.summary.parameters[0].free);
    // Loss values decide to eps^(1/2), gradients to eps: a step of 1e-10 lowers the loss by 1e-20.
    BOOST_TEST(remaining_step(sets, fit.theta, 0) <= 1e-10);
    BOOST_TEST(remaining_step(sets, pair(0.55, 0.5), 0) > 1e-4);  // where the free search left b1
    BOOST_TEST(std::abs(fit.theta[0] - 0.55) > 1e-4);
  }
}

BOOST_AUTO_TEST_CASE(fixed_parameters_stay_and_the_others_find_their_own_optimum) {
  const auto& sets = exact_sets();
  const auto free = fit_to(sets).theta;
  const auto fit = sets.learned(two_stages, galaxy,
                                {.loss = loss_named("state:1"), .random_starts = 2, .fixed = {0.45, {}}});
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    BOOST_TEST(fit.theta[0] == 0.45);
    BOOST_TEST(!fit.summary.parameters[0].free);
    BOOST_TEST(fit.summary.parameters[0].standard_error == 0.0);
    BOOST_TEST(std::isnan(fit.summary.parameters[1].standard_error));  // thirty trajectories do not tell
    BOOST_TEST(says(fit.summary.errors_withheld, "they rest on"));
    BOOST_TEST(says(fit.summary.full(), "not known: " + fit.summary.errors_withheld));
    BOOST_TEST(remaining_step(sets, fit.theta, 1) <= 1e-10);
    BOOST_TEST(remaining_step(sets, pair(0.45, free[1]), 1) > 1e-4);  // that of the free fit is another
  }
  const auto fixed = fit_to(sets, {.fixed = {0.45, 0.4}});  // where all is fixed nothing moves
  BOOST_TEST((fixed.theta == pair(0.45, 0.4)));
  BOOST_TEST(fixed.summary.iterations == 0);
  BOOST_TEST(fixed.summary.usable);
  BOOST_TEST((!fixed.summary.parameters[0].free && !fixed.summary.parameters[1].free));
}

BOOST_AUTO_TEST_CASE(more_starts_are_never_worse_to_the_judge) {
  const auto sets = made_by(fine_steps(0.02), 0.8, starts);
  const auto of = [&](const fit_options& options) {
    return sets.learned(four_kicks, galaxy, options).summary;
  };
  const loss_choice loss = loss_named("state:1");
  const auto alone = of({.loss = loss, .start = four_kicks.starts[1].theta, .random_starts = 0});
  const auto both = of({.loss = loss, .random_starts = 0});
  const auto many = of({.loss = loss, .random_starts = 4});
  BOOST_TEST_CONTEXT(alone.full() << both.full() << many.full()) {
    BOOST_TEST(alone.starts_tried == 1);
    BOOST_TEST(both.starts_tried == 3);  // the family's own two, and the phase-fitted one
    BOOST_TEST(many.starts_tried == 7);
    BOOST_TEST(both.trajectory_error <= alone.trajectory_error);
    BOOST_TEST(many.trajectory_error <= both.trajectory_error * (1.0 + 1e-9));  // where minimisers end
  }
  // Of another seed the random starts are others, and cost other searches.
  const auto other = of({.loss = loss, .random_starts = 4, .seed = 2});
  BOOST_TEST(other.learning_evaluations != many.learning_evaluations);
}

// On one oscillator four kicks have a direction too many. The search goes as far as the others matter.
BOOST_AUTO_TEST_CASE(a_flat_direction_is_reported_and_the_rest_is_learned) {
  const harmonic_oscillator oscillator(2.0);
  const auto data = make_flow_map_data(oscillator, around_rest<1>(0.4, 0.4), exact_linear(oscillator),
                                       {.step = 0.5, .horizon = 2.0, .trajectories = 20});
  const metric measure(oscillator, data, coordinates::qp);
  const after_steps<> loss(four_kicks, oscillator, data, state_error(measure));
  const auto fit = learn(four_kicks, oscillator, data, data, {.loss = loss_named("state:1")});
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    BOOST_TEST(fit.summary.usable);
    BOOST_TEST(fit.summary.loss <= 1e-24);
    BOOST_REQUIRE(fit.summary.flat_directions.size() == 1);
    const Eigen::VectorXd flat = Eigen::Map<const Eigen::Vector3d>(fit.summary.flat_directions[0].data());
    const symmetric_eigen of_loss(loss.at(fit.theta).normal_matrix);
    // Residuals vanish at the minimum, so the normal matrix is half the Hessian: the same direction is flat.
    BOOST_TEST(std::abs(of_loss.vectors.col(0).dot(flat)) >= 1.0 - 1e-6);
    BOOST_TEST(of_loss.values[0] <= 1e-8 * of_loss.values[2]);
    BOOST_TEST(of_loss.values[1] > 1e-8 * of_loss.values[2]);
  }
}

// An error of the phase after 88 steps, of which one step shows as much as of errors that do not add up.
BOOST_AUTO_TEST_CASE(whole_trajectories_tell_which_errors_add_up) {
  const auto sets = sets_at(0.09);
  const fit_options options{.coordinates = coordinates::energy, .random_starts = 4};
  const auto by_trajectory = fitted(sets, family(fg4{}), "trajectory", options);
  const auto by_step = fitted(sets, family(fg4{}), "state:1", options);
  BOOST_TEST_CONTEXT(by_trajectory.full() << by_step.full()) {
    BOOST_TEST(by_trajectory.usable);
    BOOST_TEST(by_trajectory.trajectory_error < 0.25 * by_step.trajectory_error);
    BOOST_TEST(by_trajectory.one_step_error > by_step.one_step_error);  // which misleads
    BOOST_TEST(by_trajectory.loss_steps == 88);
    BOOST_TEST(by_trajectory.follows_to_the_end());
    BOOST_TEST(by_trajectory.following() == "");
  }
}

// Two stages have no parameter for the phase of a stiff spring.
BOOST_AUTO_TEST_CASE(where_no_member_follows_the_data_the_loss_looks_at_fewer_steps) {
  const auto sets = sets_at(0.04);
  const auto two = fitted(sets, two_stages, "trajectory", {.random_starts = 8});
  BOOST_TEST(two.loss_steps <= 13);
  BOOST_TEST(!two.follows_to_the_end());
  BOOST_TEST(two.brief().ends_with("; but " + two.following()));
  BOOST_TEST(says(two.following(), two.follows ? "not for 200" : "a twentieth"));
  const auto of_five = fitted(sets, two_stages, "state:5", {.random_starts = 8});
  BOOST_TEST(of_five.loss_steps == 5);
  BOOST_TEST(of_five.follows_to_the_end());  // a loss of few steps says nothing of more
}

// In 100 double steps of Verlet the angle of the fast oscillator errs by six turns where h omega = 3, and by
// .004 where it is .15; that of the slow one, which moves far more, by .001 and less.
BOOST_AUTO_TEST_CASE(what_follows_a_slow_motion_alone_follows_not) {
  const normal_around<2> starts({{1.0, 0.002}, {0.0, 0.1}}, 1e-3, 1e-3);
  const nysalt::family family{aba<2>{}};
  for (const double step : {0.06, 0.003}) {
    const data_options options{.step = step, .horizon = 100.0 * step, .trajectories = 3};
    const data_sets sets(two_speeds{}, starts, fine_steps(step / 60.0), options);
    const learning_problem problem(family, two_speeds{}, sets.data, sets.held_out, {});
    BOOST_TEST(problem.follows(family.starts.front().theta) == (step == 0.003));
  }
}

// From few starts a search among eleven parameters misses what five have.
BOOST_AUTO_TEST_CASE(a_larger_family_begins_at_the_optimum_of_the_one_that_it_contains) {
  const auto sets = sets_at(0.12);
  const fit_options options{.random_starts = 2, .planned_steps = 2000};
  family larger{bab6_free{}};
  const auto found = sets.learned(larger, chain, options).summary;
  larger.contained.reset();
  const auto found_alone = sets.learned(larger, chain, options).summary;
  BOOST_TEST_CONTEXT(found.full() << found_alone.full()) {
    BOOST_TEST(found.from == "best of bab6");
    BOOST_TEST(found.follows_to_the_end());
    BOOST_TEST((!found_alone.follows_to_the_end() || found_alone.loss > 2.0 * found.loss));
  }
}

BOOST_AUTO_TEST_CASE(the_loss_takes_the_energy_coordinates_of_systems_with_modes_unless_told) {
  const auto sets = sets_at(0.05);
  const auto coordinates_of = [&](const fit_options& options) {
    return learning_problem(two_stages, chain, sets.data, sets.held_out, options).facts.coordinates;
  };
  BOOST_TEST(coordinates_of({}) == "energy");
  BOOST_TEST(coordinates_of({.coordinates = coordinates::qp}) == "qp");
  BOOST_TEST(coordinates_of({.loss = loss_named("state:1")}) == "qp");
  BOOST_TEST(usual_loss(bath::of_sigma(0.0, 0.0)).description() == "trajectory");
  BOOST_TEST(usual_loss(bath::of_sigma(0.01, 0.05)).description() == "state:1");
}

BOOST_AUTO_TEST_CASE(more_effort_is_more_starts) {
  const auto sets = sets_at(0.05);
  const auto tried = [&](effort how, const char* loss) {
    return fitted(sets, two_stages, loss, {.effort = how}).starts_tried;
  };
  const int quick = tried(effort::quick, "trajectory");
  BOOST_TEST(tried(effort::normal, "trajectory") == quick + 16);  // a fifth of 120 in place of 40
  BOOST_TEST(tried(effort::quick, "state:1") == quick);
  BOOST_TEST(tried(effort::thorough, "state:1") == quick + 72);  // and 400
}

BOOST_AUTO_TEST_CASE(enough_trajectories_tell_what_as_many_tell_at_once) {
  data_options made{.step = h, .horizon = 5.0 * h, .trajectories = 8};
  const reference accurate = fine_steps(h / 20.0);
  const fit_options options{.loss = loss_named("state:1"), .random_starts = 0, .planned_steps = 500};
  const auto enough = learn_enough(two_stages, galaxy, gentle_starts, accurate,
                                   {.first = made, .enough = {.share = 0.05, .most = 64}}, options);
  made.trajectories = enough.course.stops.back().trajectories;
  BOOST_TEST(made.trajectories > 8);
  const data_sets sets(galaxy, gentle_starts, accurate, made);
  BOOST_TEST((enough.theta == sets.learned(two_stages, galaxy, options).theta));
}

BOOST_AUTO_TEST_CASE(the_loss_on_oscillators_is_the_distance_of_the_matrices_and_its_gradient_the_slope) {
  const double z = 1.3;
  const auto loss = detail::oscillator_loss(family(bab<2>{}), {{z, z}}, 1.0);
  // B(1/4) A(1/2) B(1/2) A(1/2) B(1/4) twice half a step of kick-drift-kick, in coordinates (z q, p).
  const double h = 0.5;
  const double turn = 1.0 - 0.5 * h * h * z * z;
  const Eigen::Matrix2d half{{turn, h * z}, {-h * z * (1.0 - 0.25 * h * h * z * z), turn}};
  const Eigen::Matrix2d exact{{std::cos(z), std::sin(z)}, {-std::sin(z), std::cos(z)}};
  const double expected = (half * half - exact).squaredNorm();
  BOOST_TEST(std::abs(loss(Eigen::VectorXd::Constant(1, 0.25)).value - expected) <= 100.0 * eps);
  BOOST_TEST(expected > 1e-3);

  const family four_kicks{bab<4>{}};
  const auto of_bands = detail::oscillator_loss(four_kicks, {{0.0, 5.0}, {49.0, 51.0}}, 0.05);
  const Eigen::VectorXd theta = four_kicks.starts.front().theta.array() + 0.03;
  const Eigen::VectorXd ours = of_bands(theta).gradient();
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    const central_difference difference([&](const auto& at) { return of_bands(at).value; }, theta, k);
    const double s = 1e-4;
    // Entries of a matrix below 100 round in some 100 operations.
    const double rounding = 1e4 * eps * std::sqrt(of_bands(theta).value) / s;
    BOOST_TEST(std::abs(ours[k] - difference(s)) <= 2.0 * difference.truncation(s) + rounding);
    BOOST_TEST(std::abs(ours[k]) > 1e-3);
  }
  // There is none where rotations are exact or nothing moves.
  BOOST_TEST(!detail::oscillator_loss(family(r_aba<2>{}), {{0.0, 5.0}}, 0.05));
  BOOST_TEST(!detail::oscillator_loss(family(bab<2>{}), {{0.0, 0.0}}, 0.05));
}
