// SPDX-License-Identifier: BSL-1.0
#include "nysalt/learning/theta_curve.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "../support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;

Eigen::VectorXd one(double x) { return Eigen::VectorXd::Constant(1, x); }

/// theta = (1 - 2 h + 3 h^2 - h^3, h) at some steps.
theta_curve cubic(const std::vector<double>& steps) {
  std::vector<Eigen::VectorXd> thetas;
  for (const double h : steps) thetas.push_back(Eigen::Vector2d(1.0 + h * (-2.0 + h * (3.0 - h)), h));
  return {steps, thetas};
}

}  // namespace

BOOST_AUTO_TEST_CASE(at_a_learned_step_it_is_what_was_learned) {
  const auto curve = cubic({0.1, 0.2, 0.4});
  for (std::size_t k = 0; k < 3; ++k) {
    BOOST_TEST((curve.at(curve.steps()[k]) == curve.thetas()[k]));
    BOOST_TEST((curve.at(curve.steps()[k] * (1.0 + 1e-12)) == curve.thetas()[k]));  // as typed
    BOOST_TEST(curve.has(curve.steps()[k]));
  }
  BOOST_TEST(!curve.has(0.3));
  BOOST_TEST(curve.covers(0.3));
}

BOOST_AUTO_TEST_CASE(between_four_steps_cubics_are_met_and_others_nearly) {
  const auto curve = cubic({0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  for (const double h : {0.12, 0.25, 0.31, 0.45, 0.58}) {
    const Eigen::Vector2d exact(1.0 + h * (-2.0 + h * (3.0 - h)), h);
    // Some ten products of numbers of order one for each of four terms, whose weights are below 2.
    BOOST_TEST((curve.at(h) - exact).cwiseAbs().maxCoeff() <= 80.0 * std::numeric_limits<double>::epsilon());
  }
  // Through three points the curve is a parabola: it cannot be a cubic.
  const auto coarse = cubic({0.1, 0.3, 0.6});
  BOOST_TEST(std::abs(coarse.at(0.2)[0] - (1.0 + 0.2 * (-2.0 + 0.2 * (3.0 - 0.2)))) > 1e-4);
}

BOOST_AUTO_TEST_CASE(beyond_its_ends_a_curve_says_no) {
  const auto curve = cubic({0.1, 0.2});
  BOOST_TEST(!curve.covers(0.0999));
  BOOST_TEST(refuses<wrong>([&] { curve.at(0.0999); }, {"0.1 to 0.2", "0.0999"}));
  BOOST_TEST(refuses<wrong>([&] { curve.at(0.21); }, {"0.21"}));
  const theta_curve point({0.1}, {one(3.0)});
  BOOST_TEST(point.at(0.1)[0] == 3.0);
  BOOST_TEST(refuses<wrong>([&] { point.at(0.11); }, {"0.11"}));
}

BOOST_AUTO_TEST_CASE(steps_rise_and_thetas_are_as_many) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const std::vector<double>& steps, const std::vector<Eigen::VectorXd>& thetas) {
    return refuses<wrong>([&] { theta_curve(steps, thetas); }, {"rising steps"});
  };
  BOOST_TEST(refused({}, {}));
  BOOST_TEST(refused({0.1}, {}));
  BOOST_TEST(refused({0.0}, {one(1.0)}));
  BOOST_TEST(refused({0.2, 0.1}, {one(1.0), one(1.0)}));
  BOOST_TEST(refused({0.1, 0.1}, {one(1.0), one(1.0)}));
  BOOST_TEST(refused({0.1, nan}, {one(1.0), one(1.0)}));
  BOOST_TEST(refused({0.1, 0.2}, {one(1.0), one(nan)}));
  BOOST_TEST(refused({0.1, 0.2}, {one(1.0), Eigen::VectorXd::Zero(2)}));
}
