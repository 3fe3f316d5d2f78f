// SPDX-License-Identifier: BSL-1.0
// Larger families: the member that made the data is found, and several starts find the same to the last bit.
#include <boost/test/unit_test.hpp>

#include <Eigen/Core>

#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/fg4.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/metric.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/state_error.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
constexpr double h = 0.8;
const henon_heiles galaxy;

struct data_sets {
  flow_map_data data, held_out;
};
data_sets made_by(const auto& reference, int threads = 1) {
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.15, 0.2);
  const auto make = [&](std::uint64_t seed) {
    return make_flow_map_data(
        galaxy, starts, reference,
        {.step = h, .horizon = 4.0, .trajectories = 30, .seed = seed, .threads = threads});
  };
  return {make(1), make(2)};
}

/// How far theta can be off where the minimum is zero but for rounding: residuals of some 100 roundings, in
/// units of increments of .1 or more, over the least singular value of the Jacobian.
double recovery_error(const data_sets& sets, const run_time_family& family, const Eigen::VectorXd& theta) {
  const metric measure(galaxy, sets.data, coordinates::qp);
  const after_steps loss(family, galaxy, sets.data, state_error(measure));
  const symmetric_eigen of_loss(squares_at(loss, theta).normal_matrix);
  return std::sqrt(4.0) * 100.0 * eps / 0.1 / std::sqrt(of_loss.values[0]);
}

template <Family F>
void check_recovery(double reach) {
  draws random;
  const run_time_family family{F()};
  for (int n = 0; n < 3; ++n) {
    auto theta = F::start();
    for (double& x : theta) x += random.uniform(-reach, reach);
    const auto sets = made_by(fine_steps(h, member<F>(theta)));
    // The loss has other minima, of which some are very low: several starts find the one that is zero.
    for (const loss_choice& loss : {loss_choice{}, loss_named("state:3")}) {
      const auto found = learn(family, galaxy, sets.data, sets.held_out, {.loss = loss, .random_starts = 4});
      const double allowed = recovery_error(sets, family, column_of(theta));
      const double off = (found.theta - column_of(theta)).cwiseAbs().maxCoeff();
      BOOST_TEST_MESSAGE(F::name << ", " << loss.description() << ": error " << off << " of " << allowed);
      BOOST_TEST_CONTEXT("seed " << draws::seed << "\n" << found.summary.full()) {
        BOOST_TEST(off <= allowed);
        BOOST_TEST(allowed <= 1e-8);  // which says something
        BOOST_TEST(found.summary.loss_name == loss.description());
      }
    }
    // Half the step is another map, and nothing in the family is it.
    const auto other = made_by(fine_steps(0.5 * h, member<F>(theta)));
    const auto found = learn(family, galaxy, other.data, other.held_out);
    BOOST_TEST((found.theta - column_of(theta)).norm() > 1e-6);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_member_that_made_the_data_is_recovered) {
  check_recovery<aba<4>>(0.03);
  check_recovery<fg4>(0.02);
}

BOOST_AUTO_TEST_CASE(the_same_seed_finds_the_same_to_the_last_bit) {
  const run_time_family family{aba<4>()};
  const auto found = [&](int threads, std::uint64_t seed) {
    const auto sets = made_by(fine_steps<>(h / 40.0), threads);
    return learn(family, galaxy, sets.data, sets.held_out,
                 {.random_starts = 3, .seed = seed, .threads = threads});
  };
  const auto one = found(1, 1);
  BOOST_TEST(one.summary.starts_tried == 6);  // the family's own two, three more, and the phase-fitted one
  for (const int threads : {2, 3}) {
    const auto more = found(threads, 1);
    BOOST_TEST((more.theta == one.theta));
    BOOST_TEST(more.summary.from == one.summary.from);
    BOOST_TEST(more.summary.trajectory_error == one.summary.trajectory_error);
    BOOST_TEST(more.summary.learning_evaluations == one.summary.learning_evaluations);
  }
  // Of another seed the random starts are others, and cost other searches.
  BOOST_TEST(found(1, 2).summary.learning_evaluations != one.summary.learning_evaluations);
}

BOOST_AUTO_TEST_CASE(more_starts_are_never_worse_to_the_judge) {
  const auto sets = made_by(fine_steps<>(h / 40.0));
  const run_time_family family{aba<4>()};
  const auto of = [&](const fit_options& options) {
    return learn(family, galaxy, sets.data, sets.held_out, options).summary;
  };
  const loss_choice loss = loss_named("state:1");
  const auto alone = of({.loss = loss, .start = family.starts[1].theta, .random_starts = 0});
  const auto both = of({.loss = loss, .random_starts = 0});
  const auto many = of({.loss = loss, .random_starts = 4});
  BOOST_TEST_CONTEXT(alone.full() << both.full() << many.full()) {
    BOOST_TEST(alone.starts_tried == 1);
    BOOST_TEST(both.starts_tried == 3);
    BOOST_TEST(many.starts_tried == 7);
    BOOST_TEST(both.trajectory_error <= alone.trajectory_error);
    BOOST_TEST(many.trajectory_error <= both.trajectory_error * (1.0 + 1e-9));  // where minimisers end
  }
}

BOOST_AUTO_TEST_CASE(what_is_fixed_stays_in_every_start) {
  const auto sets = made_by(fine_steps<>(h / 40.0));
  const auto found = learn(run_time_family(aba<4>()), galaxy, sets.data, sets.held_out,
                           {.random_starts = 2, .fixed = {std::nullopt, 0.3, std::nullopt}});
  BOOST_TEST(found.theta[1] == 0.3);
  BOOST_TEST(!found.summary.parameters[1].free);
  BOOST_TEST(found.theta[0] != aba<4>::start()[0]);
}

BOOST_AUTO_TEST_CASE(what_does_not_fit_the_family_is_refused) {
  const auto sets = made_by(fine_steps<>(h / 40.0));
  const auto refused = [&](const run_time_family& family, const fit_options& options,
                           std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { learn(family, galaxy, sets.data, sets.held_out, options); }, words);
  };
  const run_time_family four{aba<4>()};
  BOOST_TEST(refused(four, {.start = Eigen::Vector2d(0.1, 0.2)}, {"aba4", "must be 3"}));
  BOOST_TEST(refused(four, {.start = Eigen::Vector3d(0.1, 9.0, 0.2)}, {"aba4", "b1", "9"}));
  BOOST_TEST(refused(four, {.fixed = {0.1, 0.2}}, {"aba4", "must be 3"}));
  BOOST_TEST(refused(four, {.random_starts = -1}, {"random_starts", "-1"}));
  BOOST_TEST(refused(four, {.loss = loss_named("state:6")}, {"6 steps", "longer horizon"}));
  BOOST_TEST(refused(four, {.loss = loss_named("covariance")}, {"covariance", "henon_heiles"}));
}
