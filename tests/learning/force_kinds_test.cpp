// SPDX-License-Identifier: BSL-1.0
// Compiled at -O0, where it runs for 4.6 s: -O1 would take longer to compile than it saves.
// However a person writes the force, and in whatever units, the same is learned; and the summary says where
// derivatives came from.
#include "../../src/nysalt/learning/curvature.hpp"
#include "../../src/nysalt/learning/data_of_problem.hpp"
#include "../support/black_box_in_units.hpp"
#include "../support/dense.hpp"
#include "../support/learned.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

// A pendulum in four ways. One description, as the data are the same.
struct well {
  static constexpr int dimension = 1;
  static std::string description() { return "a pendulum"; }
};
struct by_potential : well {
  template <class T>
  T potential(const vector<T, 1>& q) const {
    using std::cos;
    return -cos(q[0]);
  }
};
struct by_force : well {
  double strength = 1.0;
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    using std::sin;
    f[0] = -sin(q[0]) * strength;
  }
};
struct by_black_box : well {
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = -std::sin(q[0]); }
};
struct by_black_box_with_derivative : by_black_box {
  double strength = 1.0;  // of the derivative alone
  void force_derivative(const vector<double, 1>& q, const vector<double, 1>& v, vector<double, 1>& g) const {
    g[0] = -std::cos(q[0]) * v[0] * strength;
  }
};

const by_force exact;
const family two_stages{nystrom()};
const fit_options quick{.random_starts = 2, .planned_steps = 300};

const data_sets& pendulums() {
  static const data_sets sets(exact,
                              normal_around<1>({vector<double, 1>(0.5), vector<double, 1>(0.0)}, 0.5, 0.5),
                              fine_steps(0.02), {.step = 0.6, .horizon = 3.0, .trajectories = 20});
  return sets;
}

/// How far theta moves where every derivative of a residual is off by `relative` of the largest: the gradient
/// moves by 2 |r| |dJ|, and theta by that over the smallest curvature.
double allowed(const flow_map_data& data, const Eigen::VectorXd& theta, double relative) {
  const metric measure(exact, data, coordinates::qp);
  const after_steps<> loss(two_stages, exact, data, state_error(measure));
  const symmetric_eigen of_loss(hessian(detail::objective_of(loss), theta));
  const double jacobian = std::sqrt(0.5 * of_loss.values[1]);  // the Hessian is 2 J^T J and a little more
  return 2.0 * std::sqrt(loss.value(theta)) * 2.0 * jacobian * relative / of_loss.values[0];
}

double distance_of(const fit& a, const fit& b) { return (a.theta - b.theta).cwiseAbs().maxCoeff(); }

/// Learned of data in some units, with a mistake in the first coordinate's force if the factor is not 1.
template <class S>
Eigen::VectorXd learned_for(const family& family, const units& scales, double factor = 1.0) {
  S system;
  system.scales = scales;
  S wrong = system;
  wrong.first_factor = factor;
  const double h = 0.6 * scales.time;
  const data_sets sets(system, starts_in_units<2>(system), fine_steps(h / 32.0),
                       {.step = h, .horizon = 4.0 * h, .trajectories = 10});
  // The optimum itself.
  return sets.learned(family, wrong, {.random_starts = 2, .guarded = false, .planned_steps = 300}).theta;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_same_is_learned_however_the_force_is_written) {
  const auto& sets = pendulums();
  const auto fitted = [&](const model& system) { return sets.learned(two_stages, system, quick); };
  const auto expected = fitted(exact);
  const auto potential = fitted(by_potential());
  const auto boxed = fitted(by_black_box());
  const auto derived = fitted(by_black_box_with_derivative());
  const double rounding = allowed(sets.data, expected.theta, 100.0 * eps);  // operations of a step
  // A central difference along a displacement below 1, of a sine, is off by s^2/6, and eps/s by rounding.
  constexpr double s = detail::part_of_displacement;
  const double differences = allowed(sets.data, expected.theta, s * s / 6.0 + 4.0 * eps / s + 100.0 * eps);
  BOOST_TEST_CONTEXT(expected.summary.full()) {
    BOOST_TEST(expected.summary.usable);
    BOOST_TEST(distance_of(potential, expected) <= rounding);
    BOOST_TEST(distance_of(derived, expected) <= rounding);
    BOOST_TEST(distance_of(boxed, expected) <= differences);
    by_force wrong;  // by a thousandth of a per cent
    wrong.strength = 1.0 + 1e-5;
    BOOST_TEST(distance_of(fitted(wrong), expected) > 1e3 * differences);
  }
  BOOST_TEST(expected.summary.derivatives == "automatic differentiation");
  BOOST_TEST(potential.summary.derivatives == "automatic differentiation");
  BOOST_TEST(derived.summary.derivatives == "the system's directional derivative");
  BOOST_TEST(boxed.summary.derivatives == "central differences of the force");
  BOOST_TEST(boxed.summary.full().find("central differences of the force") != std::string::npos);
}

static_assert(!detail::force_may_be_wrong<by_potential>);
static_assert(detail::force_may_be_wrong<by_force> && detail::force_may_be_wrong<by_black_box>);

// It learns something all the same, and nothing else would tell.
BOOST_AUTO_TEST_CASE(what_contradicts_itself_is_refused_unless_asked_otherwise) {
  by_black_box_with_derivative wrong;
  wrong.strength = 0.99;
  const auto fitted = [&](const fit_options& options) {
    return pendulums().learned(two_stages, wrong, options);
  };
  BOOST_TEST(refuses([&] { fitted({}); }, {"cannot learn on", "force_derivative is not f'(q) v", "1.0",
                                           "a pendulum", "check_force = false"}));
  BOOST_TEST(fitted({.planned_steps = 300, .check_force = false}).summary.usable);
  wrong.strength = 1.0;
  BOOST_TEST(fitted(quick).summary.usable);
}

BOOST_AUTO_TEST_CASE(of_a_black_box_theta_is_the_same_in_all_units) {
  const nysalt::family family{fg_chin()};
  const auto expected = learned_for<open_wells<2>>(family, units());
  for (const units& scales : {units{.length = 1e-10}, units{.length = 1e10},
                              units{.length = 1e-10, .time = 1e-15, .mass = 1e-26, .offset = 20.0},
                              units{.length = 1e-6, .mixed = 1e12}}) {
    BOOST_TEST_CONTEXT("length " << scales.length << ", mixed " << scales.mixed << ", time " << scales.time) {
      const auto found = learned_for<boxed_wells<2>>(family, scales);
      // Derivatives are off by 1e-8 of themselves, and theta by that times the root of the Hessian's
      // condition, which is below 100.
      BOOST_TEST((found - expected).cwiseAbs().maxCoeff() < 1e-6);
    }
    BOOST_TEST(refuses([&] { learned_for<boxed_wells<2>>(family, scales, 1.001); }, {"not -grad V"}));
  }
}
