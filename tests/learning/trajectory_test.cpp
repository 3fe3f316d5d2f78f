// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 5 s at -O0, 3 s at -O1.
// What a fit to whole trajectories has over a fit to one step, and how it is found.
#include <boost/test/unit_test.hpp>

#include "../support/losses.hpp"
#include "../support/rounding.hpp"
#include "nysalt/detail/oscillator_loss.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/bab.hpp"
#include "nysalt/families/fg4.hpp"
#include "nysalt/families/free_composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/r_aba.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/learning/search.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/fpu_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const fpu_chain<3> chain(50.0);

struct data_sets {
  flow_map_data data, held_out;
};
data_sets sets_at(double step) {
  const auto make = [&](std::uint64_t seed) {
    return make_flow_map_data(chain, fpu_law<3>(chain), fine_steps<>(step / 180.0),
                              {.step = step, .horizon = 8.0, .trajectories = 8, .seed = seed});
  };
  return {make(1), make(2)};
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
  const run_time_family family{fg4{}};
  const auto learned = [&](const char* loss) {
    return learn(family, chain, sets.data, sets.held_out,
                 {.coordinates = coordinates::energy, .loss = loss_named(loss), .planned_steps = 2000});
  };
  const auto by_trajectory = learned("trajectory");
  const auto by_step = learned("state:1");
  BOOST_TEST_CONTEXT(by_trajectory.summary.full() << by_step.summary.full()) {
    BOOST_TEST(by_trajectory.summary.usable);
    BOOST_TEST(by_trajectory.summary.trajectory_error < 0.25 * by_step.summary.trajectory_error);
    BOOST_TEST(by_trajectory.summary.one_step_error > by_step.summary.one_step_error);  // which misleads
  }
}

// Two stages have no parameter for the phase of a stiff spring.
BOOST_AUTO_TEST_CASE(where_no_member_follows_the_data_the_loss_looks_at_fewer_steps) {
  const auto sets = sets_at(0.04);
  const auto fitted = [&](const auto& family, const char* loss) {
    return learn(run_time_family(family), chain, sets.data, sets.held_out,
                 {.loss = loss_named(loss), .random_starts = 8, .planned_steps = 2000})
        .summary;
  };
  const auto four = fitted(fg4{}, "trajectory");
  BOOST_TEST(four.loss_steps == 200);
  BOOST_TEST(four.follows_to_the_end());
  BOOST_TEST(four.following() == "");
  const auto two = fitted(nystrom{}, "trajectory");
  BOOST_TEST(two.loss_steps <= 13);
  BOOST_TEST(!two.follows_to_the_end());
  BOOST_TEST(two.brief().ends_with("; but " + two.following()));
  BOOST_TEST(two.following().find(two.follows ? "not for 200" : "a twentieth") != std::string::npos);
  const auto of_five = fitted(nystrom{}, "state:5");
  BOOST_TEST(of_five.loss_steps == 5);
  BOOST_TEST(of_five.follows_to_the_end());  // a loss of few steps says nothing of more
}

// In 100 double steps of Verlet the angle of the fast oscillator errs by six turns where h omega = 3, and by
// .004 where it is .15; that of the slow one, which moves far more, by .001 and less.
BOOST_AUTO_TEST_CASE(what_follows_a_slow_motion_alone_follows_not) {
  const phase_point<double, 2> centre{{1.0, 0.002}, {0.0, 0.1}};
  const auto follows = [&](double step) {
    const auto make = [&](std::uint64_t seed) {
      return make_flow_map_data(two_speeds{}, normal_around<2>(centre, 1e-3, 1e-3), fine_steps<>(step / 60.0),
                                {.step = step, .horizon = 100.0 * step, .trajectories = 3, .seed = seed});
    };
    const auto data = make(1);
    const run_time_family family{aba<2>{}};
    const auto problem = make_learning_problem(family, two_speeds{}, data, make(2), {});
    return problem.follows(family.starts.front().theta);
  };
  BOOST_TEST(!follows(0.06));
  BOOST_TEST(follows(0.003));
}

// From few starts a search among eleven parameters misses what five have.
BOOST_AUTO_TEST_CASE(a_larger_family_begins_at_the_optimum_of_the_one_that_it_contains) {
  const auto sets = sets_at(0.12);
  const auto fitted = [&](const run_time_family& family) {
    return learn(family, chain, sets.data, sets.held_out, {.random_starts = 2, .planned_steps = 2000})
        .summary;
  };
  const run_time_family larger{bab6_free{}};
  run_time_family alone = larger;
  alone.contained.reset();
  const auto found = fitted(larger);
  const auto found_alone = fitted(alone);
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
}

BOOST_AUTO_TEST_CASE(in_a_bath_the_usual_loss_is_that_of_one_step) {
  BOOST_TEST(usual_loss(bath::of_sigma(0.0, 0.0)).description() == "trajectory");
  BOOST_TEST(usual_loss(bath::of_sigma(0.01, 0.05)).description() == "state:1");
}

BOOST_AUTO_TEST_CASE(more_effort_is_more_starts) {
  const auto sets = sets_at(0.05);
  const auto tried = [&](effort how, const char* loss) {
    return learn(run_time_family(nystrom{}), chain, sets.data, sets.held_out,
                 {.loss = loss_named(loss), .effort = how, .planned_steps = 2000})
        .summary.starts_tried;
  };
  const int quick = tried(effort::quick, "trajectory");
  BOOST_TEST(tried(effort::normal, "trajectory") == quick + 16);  // a fifth of 120 in place of 40
  BOOST_TEST(tried(effort::quick, "state:1") == quick);
  BOOST_TEST(tried(effort::thorough, "state:1") == quick + 72);  // and 400
}

BOOST_AUTO_TEST_CASE(the_slope_of_the_loss_on_oscillators_is_its_gradient) {
  const run_time_family family{bab<4>{}};
  const auto loss = detail::oscillator_loss(family, {{0.0, 5.0}, {49.0, 51.0}}, 0.05);
  Eigen::VectorXd theta = family.starts.front().theta;
  theta.array() += 0.03;
  const Eigen::VectorXd ours = loss(theta).gradient();
  const auto value = [&](const Eigen::VectorXd& at) { return loss(at).value; };
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    const central_difference difference(value, theta, k);
    const double s = 1e-4;
    // Entries of a matrix below 100 round in some 100 operations.
    const double rounding = 1e4 * eps * std::sqrt(loss(theta).value) / s;
    BOOST_TEST(std::abs(ours[k] - difference(s)) <= 2.0 * difference.truncation(s) + rounding);
    BOOST_TEST(std::abs(ours[k]) > 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(the_loss_on_oscillators_is_the_distance_of_the_matrices) {
  const run_time_family family{bab<2>{}};
  const Eigen::VectorXd theta = Eigen::VectorXd::Constant(1, 0.25);
  const double z = 1.3;
  const auto loss = detail::oscillator_loss(family, {{z, z}}, 1.0);
  // B(1/4) A(1/2) B(1/2) A(1/2) B(1/4) twice half a step of kick-drift-kick, in coordinates (z q, p).
  const double h = 0.5;
  Eigen::Matrix2d half;
  half << 1.0 - 0.5 * h * h * z * z, h * z, -h * z * (1.0 - 0.25 * h * h * z * z), 1.0 - 0.5 * h * h * z * z;
  Eigen::Matrix2d exact;
  exact << std::cos(z), std::sin(z), -std::sin(z), std::cos(z);
  const double expected = (half * half - exact).squaredNorm();
  BOOST_TEST(std::abs(loss(theta).value - expected) <= 100.0 * eps);
  BOOST_TEST(expected > 1e-3);
}

BOOST_AUTO_TEST_CASE(there_is_no_loss_on_oscillators_where_rotations_are_exact_or_nothing_moves) {
  BOOST_TEST(!detail::oscillator_loss(run_time_family(r_aba<2>{}), {{0.0, 5.0}}, 0.05));
  BOOST_TEST(!detail::oscillator_loss(run_time_family(bab<2>{}), {{0.0, 0.0}}, 0.05));
}
