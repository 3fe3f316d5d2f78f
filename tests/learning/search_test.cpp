// SPDX-License-Identifier: BSL-1.0
// The search ends at the minimum: the member that made the data, wherever it lies, from wherever it starts.
#include <boost/test/unit_test.hpp>

#include <Eigen/Core>

#include "../laws/models.hpp"
#include "../support/dense.hpp"
#include "../support/one_step.hpp"
#include "../support/rounding.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/methods/palindromic.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using S = henon_heiles;
constexpr double h = 0.5;
const S galaxy;

/// The family's coefficients without the bound on beta1.
struct beyond_the_bound : palindromic<drift, kick, 5> {
  static constexpr int order = 2;
  parameters_of<nystrom> theta{};
  static std::string name() { return "beyond_the_bound"; }
  std::array<double, 5> coefficients() const { return nystrom::coefficients(theta); }
};

/// Training and held-out data.
struct data_sets {
  flow_map_data data, held_out;
};
data_sets made_by(const auto& reference, std::uint64_t first_seed = 1) {
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.06, 0.12);  // none leaves, at this step
  const auto make = [&](std::uint64_t seed) {
    return make_flow_map_data(galaxy, starts, reference,
                              {.step = h, .horizon = 2.0, .trajectories = 30, .seed = seed});
  };
  return {make(first_seed), make(first_seed + 1)};
}
learned<nystrom> fit_to(const data_sets& sets, learn_options<nystrom> options = {}) {
  options.loss = loss_named("state:1");
  options.random_starts = 0;
  return learn(nystrom{}, galaxy, sets.data, sets.held_out, options);
}

/// How far theta can be off where the minimum of the loss is zero but for rounding. Data and step err by
/// some 12 roundings of the magnified state each, in units of the mean increment; the least-squares solution
/// by that over the smallest singular value of the Jacobian, sqrt(lambda_min/2) with the Hessian's lambda.
double recovery_error(const data_sets& sets, const parameters_of<nystrom>& theta) {
  const metric measure(galaxy, sets.data, coordinates::qp);
  const one_step<nystrom> loss(galaxy, sets.data, measure);
  // |V''| <= 1 + 4 |q|, and |q| stays below 1/2. Beyond its bound the family's coefficients grow no larger.
  const double magnified =
      transient_growth(member<nystrom>({theta[0], std::min(0.5, theta[1])}), h, {3.0, 1.0, 0.0});
  Eigen::Vector4d squares = Eigen::Vector4d::Zero();
  for (std::size_t n = 0; n < sets.data.pairs(); ++n) {
    const auto& x = sets.data.start[n];
    const auto& y = sets.data.finish[n];
    squares +=
        Eigen::Vector4d(y.q[0] - x.q[0], y.q[1] - x.q[1], y.p[0] - x.p[0], y.p[1] - x.p[1]).cwiseAbs2();
  }
  const double least = std::sqrt(squares.minCoeff() / static_cast<double>(sets.data.pairs()));
  const double residual = std::sqrt(4.0) * 24.0 * eps * magnified / least;
  const symmetric_eigen of_loss(hessian(loss, theta));
  return residual / std::sqrt(0.5 * of_loss.values[0]);
}

double distance_of(const parameters_of<nystrom>& a, const parameters_of<nystrom>& b) {
  return std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1]));
}

/// Free parameters are at a stationary point: the last Newton step, in parameters.
double remaining_step(const data_sets& sets, const parameters_of<nystrom>& theta, Eigen::Index free) {
  const metric measure(galaxy, sets.data, coordinates::qp);
  const one_step<nystrom> loss(galaxy, sets.data, measure);
  const curvature bend(hessian(loss, theta), {free});
  return std::abs(bend.solve(squares_at(loss, theta).gradient())[free]);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_member_that_made_the_data_is_recovered) {
  draws random;
  for (int n = 0; n < 6; ++n) {
    // Far from the start the loss has other minima, with a drift forth and back, which are not asked for.
    const parameters_of<nystrom> theta{random.uniform(0.35, 0.6), random.uniform(0.25, 0.5)};
    const member<nystrom> maker(theta);
    const auto sets = made_by(fine_steps(h, maker));
    const auto fit = fit_to(sets);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", b1 = " << theta[0] << ", beta1 = " << theta[1] << "\n"
                               << fit.summary.full()) {
      const double allowed = recovery_error(sets, theta);
      BOOST_TEST_MESSAGE("error " << distance_of(fit.method.parameters(), theta) << " of " << allowed);
      BOOST_TEST(distance_of(fit.method.parameters(), theta) <= allowed);
      BOOST_TEST(fit.summary.parameters[0].free);
      BOOST_TEST(fit.summary.parameters[1].free);
      // Half the step is another map, and nothing in the family is it.
      const auto other = fit_to(made_by(fine_steps(0.5 * h, maker)));
      BOOST_TEST(distance_of(other.method.parameters(), theta) > 1e3 * allowed);
    }
  }
}

BOOST_AUTO_TEST_CASE(verlet_lies_on_the_bound_and_is_recovered) {
  for (std::uint64_t seed = 1; seed < 40; seed += 2) {
    const auto sets = made_by(fine_steps<verlet>(h), seed);
    const auto fit = fit_to(sets, {.guarded = false});  // at this step Verlet loses some starts
    BOOST_TEST_CONTEXT(fit.summary.full()) {
      const auto found = fit.method.parameters();
      BOOST_TEST(distance_of(found, {0.5, 0.5}) <= recovery_error(sets, {0.5, 0.5}));
      BOOST_TEST(found[1] == 0.5);
      BOOST_TEST(!fit.summary.parameters[1].free);
      BOOST_TEST(fit.summary.parameters[1].standard_error == 0.0);
    }
  }
}

BOOST_AUTO_TEST_CASE(an_optimum_beyond_the_bound_is_held_there_and_the_other_parameter_fitted_again) {
  beyond_the_bound maker;
  maker.theta = {0.55, 0.53};
  const auto sets = made_by(fine_steps(h, maker));
  const auto fit = fit_to(sets);
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    const auto found = fit.method.parameters();
    BOOST_TEST(found[1] == 0.5);
    BOOST_TEST(!fit.summary.parameters[1].free);
    BOOST_TEST(fit.summary.parameters[0].free);
    // Loss values decide to eps^(1/2), gradients to eps: a step of 1e-10 lowers the loss by 1e-20.
    BOOST_TEST(remaining_step(sets, found, 0) <= 1e-10);
    BOOST_TEST(remaining_step(sets, {0.55, 0.5}, 0) > 1e-4);  // where the free search left b1
    BOOST_TEST(std::abs(found[0] - 0.55) > 1e-4);
  }
}

BOOST_AUTO_TEST_CASE(fixed_parameters_stay_and_the_others_find_their_own_optimum) {
  const auto sets = made_by(fine_steps<>(h / 20.0));
  const auto free = fit_to(sets).method.parameters();
  const auto fit = fit_to(sets, {.fixed = {0.45, {}}});
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    const auto found = fit.method.parameters();
    BOOST_TEST(found[0] == 0.45);
    BOOST_TEST(!fit.summary.parameters[0].free);
    BOOST_TEST(fit.summary.parameters[0].standard_error == 0.0);
    BOOST_TEST(fit.summary.parameters[1].standard_error > 0.0);
    BOOST_TEST(remaining_step(sets, found, 1) <= 1e-10);
    BOOST_TEST(remaining_step(sets, {0.45, free[1]}, 1) > 1e-4);  // that of the free fit is another
  }
}

BOOST_AUTO_TEST_CASE(where_all_is_fixed_nothing_moves) {
  const auto sets = made_by(fine_steps<>(h / 20.0));
  const auto fit = fit_to(sets, {.fixed = {0.45, 0.4}});
  BOOST_TEST(fit.method.parameters()[0] == 0.45);
  BOOST_TEST(fit.method.parameters()[1] == 0.4);
  BOOST_TEST(fit.summary.iterations == 0);
  BOOST_TEST(fit.summary.usable);
  BOOST_TEST(!fit.summary.parameters[0].free);
  BOOST_TEST(!fit.summary.parameters[1].free);
}

BOOST_AUTO_TEST_CASE(every_start_leads_to_the_same_minimum) {
  const auto sets = made_by(fine_steps<>(h / 20.0));
  const auto first = fit_to(sets);
  draws random;
  for (int n = 0; n < 8; ++n) {
    const parameters_of<nystrom> start{random.uniform(0.35, 0.65), random.uniform(0.25, 0.5)};
    const auto fit = fit_to(sets, {.start = start});
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", from " << start[0] << ", " << start[1] << "\n"
                               << fit.summary.full()) {
      BOOST_TEST(distance_of(fit.method.parameters(), first.method.parameters()) <= 1e-9);
      BOOST_TEST(fit.summary.usable);
    }
  }
  const auto again = fit_to(sets, {.start = first.method.parameters()});
  BOOST_TEST(distance_of(again.method.parameters(), first.method.parameters()) <= 1e-9);
  BOOST_TEST(again.summary.usable);
  // What the agreement is worth: a search that is cut short ends elsewhere.
  const auto cut = fit_to(sets, {.start = {0.35, 0.25}, .max_iterations = 1});
  BOOST_TEST(distance_of(cut.method.parameters(), first.method.parameters()) > 1e-6);
}
