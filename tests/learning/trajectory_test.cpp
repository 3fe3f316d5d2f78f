// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 4.3 s at -O0, 2.7 s at -O1.
// What a fit to whole trajectories has over a fit to one step, and how it is found.
#include <boost/test/unit_test.hpp>

#include "../support/learned.hpp"
#include "../support/losses.hpp"
#include "../support/rounding.hpp"
#include "nysalt/detail/oscillator_loss.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const fpu_chain<3> chain(50.0);

data_sets sets_at(double step) {
  return {chain,
          fpu_law<3>(chain),
          fine_steps<>(step / 180.0),
          {.step = step, .horizon = 8.0, .trajectories = 8}};
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

// An error of the phase after 88 steps, of which one step shows as much as of errors that do not add up.
BOOST_AUTO_TEST_CASE(whole_trajectories_tell_which_errors_add_up) {
  const auto sets = sets_at(0.09);
  const auto fitted = [&](const char* loss) {
    const fit_options options{.coordinates = coordinates::energy,
                              .loss = loss_named(loss),
                              .random_starts = 4,
                              .planned_steps = 2000};
    return sets.learned(run_time_family(fg4{}), chain, options).summary;
  };
  const auto by_trajectory = fitted("trajectory");
  const auto by_step = fitted("state:1");
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
  const auto fitted = [&](const char* loss) {
    const fit_options options{.loss = loss_named(loss), .random_starts = 8, .planned_steps = 2000};
    return sets.learned(run_time_family(nystrom{}), chain, options).summary;
  };
  const auto two = fitted("trajectory");
  BOOST_TEST(two.loss_steps <= 13);
  BOOST_TEST(!two.follows_to_the_end());
  BOOST_TEST(two.brief().ends_with("; but " + two.following()));
  BOOST_TEST(says(two.following(), two.follows ? "not for 200" : "a twentieth"));
  const auto of_five = fitted("state:5");
  BOOST_TEST(of_five.loss_steps == 5);
  BOOST_TEST(of_five.follows_to_the_end());  // a loss of few steps says nothing of more
}

// In 100 double steps of Verlet the angle of the fast oscillator errs by six turns where h omega = 3, and by
// .004 where it is .15; that of the slow one, which moves far more, by .001 and less.
BOOST_AUTO_TEST_CASE(what_follows_a_slow_motion_alone_follows_not) {
  const normal_around<2> starts({{1.0, 0.002}, {0.0, 0.1}}, 1e-3, 1e-3);
  const run_time_family family{aba<2>{}};
  for (const double step : {0.06, 0.003}) {
    const data_options options{.step = step, .horizon = 100.0 * step, .trajectories = 3};
    const data_sets sets(two_speeds{}, starts, fine_steps<>(step / 60.0), options);
    const auto problem = make_learning_problem(family, two_speeds{}, sets.data, sets.held_out, {});
    BOOST_TEST(problem.follows(family.starts.front().theta) == (step == 0.003));
  }
}

// From few starts a search among eleven parameters misses what five have.
BOOST_AUTO_TEST_CASE(a_larger_family_begins_at_the_optimum_of_the_one_that_it_contains) {
  const auto sets = sets_at(0.12);
  const fit_options options{.random_starts = 2, .planned_steps = 2000};
  run_time_family larger{bab6_free{}};
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
  const run_time_family family{nystrom{}};
  const auto coordinates_of = [&](const fit_options& options) {
    return make_learning_problem(family, chain, sets.data, sets.held_out, options).facts.coordinates;
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
    const fit_options options{.loss = loss_named(loss), .effort = how, .planned_steps = 2000};
    return sets.learned(run_time_family(nystrom{}), chain, options).summary.starts_tried;
  };
  const int quick = tried(effort::quick, "trajectory");
  BOOST_TEST(tried(effort::normal, "trajectory") == quick + 16);  // a fifth of 120 in place of 40
  BOOST_TEST(tried(effort::quick, "state:1") == quick);
  BOOST_TEST(tried(effort::thorough, "state:1") == quick + 72);  // and 400
}

BOOST_AUTO_TEST_CASE(the_loss_on_oscillators_is_the_distance_of_the_matrices_and_its_gradient_the_slope) {
  const double z = 1.3;
  const auto loss = detail::oscillator_loss(run_time_family(bab<2>{}), {{z, z}}, 1.0);
  // B(1/4) A(1/2) B(1/2) A(1/2) B(1/4) twice half a step of kick-drift-kick, in coordinates (z q, p).
  const double h = 0.5;
  const double turn = 1.0 - 0.5 * h * h * z * z;
  const Eigen::Matrix2d half{{turn, h * z}, {-h * z * (1.0 - 0.25 * h * h * z * z), turn}};
  const Eigen::Matrix2d exact{{std::cos(z), std::sin(z)}, {-std::sin(z), std::cos(z)}};
  const double expected = (half * half - exact).squaredNorm();
  BOOST_TEST(std::abs(loss(Eigen::VectorXd::Constant(1, 0.25)).value - expected) <= 100.0 * eps);
  BOOST_TEST(expected > 1e-3);

  const run_time_family four_kicks{bab<4>{}};
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
  BOOST_TEST(!detail::oscillator_loss(run_time_family(r_aba<2>{}), {{0.0, 5.0}}, 0.05));
  BOOST_TEST(!detail::oscillator_loss(run_time_family(bab<2>{}), {{0.0, 0.0}}, 0.05));
}
