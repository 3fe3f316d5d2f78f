// SPDX-License-Identifier: BSL-1.0
// Where a learned method is valid: starts whose energies lie beyond the range of the data are distinguished
// from those outside by chance; theta at steps between the learned ones; and whether the trajectories are
// enough.
#include <boost/math/distributions/beta.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/learning/learn_enough.hpp"
#include "nysalt/learning/reach.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

Eigen::VectorXd one(double x) { return Eigen::VectorXd::Constant(1, x); }

/// theta = (1 - 2 h + 3 h^2 - h^3, h) at some steps.
theta_curve cubic(const std::vector<double>& steps) {
  std::vector<Eigen::VectorXd> thetas;
  for (const double h : steps) thetas.push_back(Eigen::Vector2d(1.0 + h * (-2.0 + h * (3.0 - h)), h));
  return {steps, thetas};
}

/// The excess over a loss of 2 is `of_one`/M, and a tenth of the trajectories decide.
enough_course course_of(double of_one, std::int64_t first, const enough_options& options,
                        std::vector<std::int64_t>* asked = nullptr) {
  return detail::until_enough(first, options, [&](std::int64_t trajectories) {
    if (asked != nullptr) asked->push_back(trajectories);
    fit_summary fit;
    fit.loss = 2.0;
    fit.expected_excess = of_one / static_cast<double>(trajectories);
    fit.deciding_trajectories = 0.1 * static_cast<double>(trajectories);
    return fit;
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_range_holds_what_it_has_seen_and_a_millionth_more) {
  energy_range seen;
  BOOST_TEST(!seen.contains(0.0));
  seen.include(-2.0);
  seen.include(1.0);
  for (const double inside : {-2.0, -2.0000015, 0.0, 1.0, 1.0000015}) BOOST_TEST(seen.contains(inside));
  for (const double outside : {-2.00001, 1.00001, 5.0, not_a_number}) BOOST_TEST(!seen.contains(outside));
  BOOST_TEST(seen.distance(3.0) == 2.0);
  BOOST_TEST(seen.distance(-5.0) == 3.0);
}

// The energies of M trajectories leave 1 - p of the law inside, p of the law beta(2, M - 1); then the number
// outside is binomial.
BOOST_AUTO_TEST_CASE(the_probability_is_that_of_the_beta_binomial_law) {
  for (const std::size_t m : {2U, 10U, 100U}) {
    for (const std::size_t n : {1U, 7U, 400U}) {
      for (const std::size_t outside : {1U, 2U, 5U}) {
        if (outside > n) continue;
        const boost::math::beta_distribution<double> left(2.0, static_cast<double>(m) - 1.0);
        const double fewer = static_cast<double>(n - outside + 1);
        const auto at_least = [&](double p) {  // of n, binomial
          return pdf(left, p) * boost::math::ibeta(static_cast<double>(outside), fewer, p);
        };
        const double expected =
            boost::math::quadrature::gauss_kronrod<double, 61>::integrate(at_least, 0.0, 1.0, 15, 1e-12);
        const energies_outside counts{
            .seen = {0.0, 1.0}, .trajectories = m, .examined = n, .outside = outside};
        BOOST_TEST_CONTEXT(outside << " of " << n << " beyond " << m) {
          BOOST_TEST(counts.probability() == expected, tolerance(1e-9));
        }
      }
    }
  }
  const energies_outside blind{.seen = {0.0, 0.0}, .trajectories = 1, .examined = 50, .outside = 50};
  BOOST_TEST(blind.probability() == 1.0);  // one trajectory tells no range
  BOOST_TEST(!blind.is_serious());
}

BOOST_AUTO_TEST_CASE(starts_of_other_energies_are_serious) {
  // By how many are outside, though it be by little; one by little is none.
  const energy_range seen{8.0, 75.0};
  for (const double elsewhere : {0.5, 76.0}) {
    const auto found = count_outside(seen, 100, std::vector(40, elsewhere));
    BOOST_TEST_CONTEXT(found.report()) BOOST_TEST(found.is_serious());
    BOOST_TEST(!count_outside(seen, 100, std::vector(1, elsewhere)).is_serious());
  }
  // A single start, and one among a thousand, if they are far enough.
  const double width = seen.high - seen.low;
  BOOST_TEST(!count_outside(seen, 100, std::vector{seen.high + 0.4 * width}).is_serious());
  BOOST_TEST(count_outside(seen, 100, std::vector{seen.high + 0.6 * width}).is_serious());
  std::vector<double> many(1000, 0.5 * (seen.low + seen.high));
  many[17] = seen.high + 2.0 * width;
  BOOST_TEST(!count_outside(seen, 100, many).is_serious());
  many[17] = seen.high + 3.0 * width;
  BOOST_TEST(count_outside(seen, 100, many).is_serious());
  // Where all had one energy, another is far.
  BOOST_TEST(!count_outside({-0.5, -0.5}, 100, std::vector(20, -0.5 * (1.0 + 1e-9))).is_serious());
  BOOST_TEST(count_outside({-0.5, -0.5}, 100, std::vector{-0.4}).is_serious());
  const auto found = count_outside({1.0, 2.0}, 100, std::vector{0.5, 1.5, 7.0});
  BOOST_TEST(found.farthest == 5.0);
  for (const char* words : {"2 of 3 starts", "1 to 2", "0.5 to 7"}) {
    BOOST_TEST(found.report().find(words) != std::string::npos, found.report());
  }
}

BOOST_AUTO_TEST_CASE(at_a_learned_step_it_is_what_was_learned_and_beyond_its_ends_it_says_no) {
  const auto curve = cubic({0.1, 0.2, 0.4});
  for (std::size_t k = 0; k < 3; ++k) {
    BOOST_TEST((curve.at(curve.steps()[k]) == curve.thetas()[k]));
    BOOST_TEST((curve.at(curve.steps()[k] * (1.0 + 1e-12)) == curve.thetas()[k]));  // as typed
    BOOST_TEST(curve.has(curve.steps()[k]));
  }
  BOOST_TEST(!curve.has(0.3));
  BOOST_TEST(curve.covers(0.3));
  BOOST_TEST(!curve.covers(0.0999));
  BOOST_TEST(refuses([&] { curve.at(0.0999); }, {"0.1 to 0.4", "0.0999"}));
  BOOST_TEST(refuses([&] { curve.at(0.41); }, {"0.41"}));
  const theta_curve point({0.1}, {one(3.0)});
  BOOST_TEST(point.at(0.1)[0] == 3.0);
  BOOST_TEST(refuses([&] { point.at(0.11); }, {"0.11"}));
}

BOOST_AUTO_TEST_CASE(between_four_steps_cubics_are_met_and_others_nearly) {
  const auto curve = cubic({0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  for (const double h : {0.12, 0.25, 0.31, 0.45, 0.58}) {
    const Eigen::Vector2d exact(1.0 + h * (-2.0 + h * (3.0 - h)), h);
    // Some ten products of numbers of order one for each of four terms, whose weights are below 2.
    BOOST_TEST((curve.at(h) - exact).cwiseAbs().maxCoeff() <= 80.0 * 0x1p-52);
  }
  // Through three points the curve is a parabola: it cannot be a cubic.
  const auto coarse = cubic({0.1, 0.3, 0.6});
  BOOST_TEST(std::abs(coarse.at(0.2)[0] - (1.0 + 0.2 * (-2.0 + 0.2 * (3.0 - 0.2)))) > 1e-4);
}

BOOST_AUTO_TEST_CASE(steps_rise_and_thetas_are_as_many) {
  const auto refused = [](const std::vector<double>& steps, const std::vector<Eigen::VectorXd>& thetas) {
    return refuses([&] { theta_curve(steps, thetas); }, {"rising steps"});
  };
  BOOST_TEST((refused({}, {}) && refused({0.1}, {}) && refused({0.0}, {one(1.0)})));
  for (const double second : {0.1, 0.2, not_a_number}) {
    BOOST_TEST(refused({0.2, second}, {one(1.0), one(1.0)}));
  }
  BOOST_TEST(refused({0.1, 0.2}, {one(1.0), one(not_a_number)}));
  BOOST_TEST(refused({0.1, 0.2}, {one(1.0), Eigen::VectorXd::Zero(2)}));
}

BOOST_AUTO_TEST_CASE(it_stops_where_the_share_is_met_and_says_where_it_is_not) {
  std::vector<std::int64_t> asked;
  const auto course = course_of(6.0, 25, {.share = 0.01}, &asked);  // 3/M
  BOOST_TEST((asked == std::vector<std::int64_t>{25, 50, 100, 200, 400}));
  BOOST_TEST(course.is_reached);
  BOOST_TEST(course.stops.back().trajectories == 400);
  BOOST_TEST(course.stops.back().share == 0.0075);
  BOOST_TEST(course.stops.size() == asked.size());
  BOOST_TEST(course.report() == "400 trajectories are enough");
  BOOST_TEST(course_of(6.0, 300, {.share = 0.01}).stops.size() == 1U);
  const auto short_of = course_of(6.0, 25, {.share = 0.01, .most = 130});
  BOOST_TEST(!short_of.is_reached);
  BOOST_TEST(short_of.stops.back().trajectories == 130);  // the last doubling is cut short
  BOOST_TEST(short_of.stops.size() == 4U);
  BOOST_TEST(short_of.report().find("130 trajectories are not enough") != std::string::npos);
  BOOST_TEST(short_of.report().find("0.023 of the loss") != std::string::npos);
  const auto untold = course_of(not_a_number, 25, {});  // what cannot be told is not waited for
  BOOST_TEST(!untold.is_reached);
  BOOST_TEST(untold.stops.size() == 1U);
}

BOOST_AUTO_TEST_CASE(a_share_that_rests_on_a_few_trajectories_does_not_count) {
  const auto course = course_of(1e-9, 25, {.share = 0.01});
  BOOST_TEST(course.is_reached);
  BOOST_TEST(course.stops.back().trajectories == 100);
  BOOST_TEST(course.stops.back().deciding == 10.0);
  const auto cut_short = course_of(1e-9, 25, {.share = 0.01, .most = 90});
  BOOST_TEST(!cut_short.is_reached);
  BOOST_TEST(cut_short.report().find("rests on 9 of them") != std::string::npos);
}

// What is learned exactly has neither loss nor excess, but rounding of both.
BOOST_AUTO_TEST_CASE(an_exact_fit_has_enough) {
  fit_summary fit;
  fit.loss = 1e-28;
  fit.expected_excess = 1e-28;
  BOOST_TEST(fit.excess_share() == 0.0);
  BOOST_TEST(!fit.is_decided_by_few());
  fit.loss = 1e-20;
  fit.expected_excess = 1e-21;
  BOOST_TEST(fit.excess_share() == 0.1, tolerance(1e-15));
  BOOST_TEST(fit.is_decided_by_few());
}

BOOST_AUTO_TEST_CASE(a_share_and_numbers_must_be_possible) {
  const auto refused = [](std::int64_t first, const enough_options& options) {
    return refuses([&] { course_of(1.0, first, options); }, {"until_enough", "share"});
  };
  BOOST_TEST((refused(25, {.share = 0.0}) && refused(25, {.share = not_a_number})));
  BOOST_TEST((refused(1, {}) && refused(25, {.most = 24})));
}
