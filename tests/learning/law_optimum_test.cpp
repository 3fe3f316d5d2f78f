// SPDX-License-Identifier: BSL-1.0
// The two stages whose stationary covariance is exact are those of the closed form in docs/langevin.md.
#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/rounding.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/learning/minimise.hpp"
#include "nysalt/losses/stationary_covariance.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double omega = 50.0;

/// Where S keeps the circle: 4 a^2 - 6 a + 1 + z^2 a^2 (1 - 2 a) = 0, by bisection.
double closed_form(double z) {
  const auto f = [&](double a) { return 4.0 * a * a - 6.0 * a + 1.0 + z * z * a * a * (1.0 - 2.0 * a); };
  double low = 0.1;
  double high = 1.0 / 3.0;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (f(low) * f(middle) <= 0.0 ? high : low) = middle;
  }
  return low;
}

/// Of nystrom on the chain with omega = 50, three stiff modes and three of frequency zero.
objective law_of(placement where, double gamma, double z) {
  const in_bath chain(fpu_chain<3>(omega), bath::of_temperature(gamma, 0.125));
  const run_time_family family = thermostatted(run_time_family(nystrom()), where);
  return objective_of(stationary_covariance(chain, family.letters, z / omega), family);
}

/// Searched from two half steps of Verlet, which are stable wherever any two stages are.
minimum best(const objective& loss, const std::vector<Eigen::Index>& free) {
  const auto in_range = [](const Eigen::VectorXd& theta) {
    return 0.0 < theta[0] && theta[0] < 1.0 && 0.0 <= theta[1] && theta[1] <= 0.5;
  };
  return minimise(loss, in_range, Eigen::Vector2d(0.5, 0.375), free, 100);
}

/// beta1 = (1 - a)/2 is known as well as the residuals are, each to some 20 roundings of entries below z^2,
/// over their slope.
double tolerance(const objective& loss, const minimum& found, double z) {
  const double slope = std::sqrt(loss(found.theta).normal_matrix(1, 1));
  return 20.0 * eps * (1.0 + z * z) / slope + eps;
}

}  // namespace

BOOST_AUTO_TEST_CASE(around_two_stages_the_law_is_exact_at_the_closed_form) {
  for (const double z : {0.5, 1.65, 3.5}) {
    for (const double gamma : {0.01, 1.0}) {
      for (const placement where : {placement::end, placement::symmetric}) {
        const auto loss = law_of(where, gamma, z);
        const double expected = 0.5 * (1.0 - closed_form(z));
        for (const std::vector<Eigen::Index>& free : {std::vector<Eigen::Index>{1}, {0, 1}}) {
          const auto found = best(loss, free);
          BOOST_TEST_CONTEXT(to_string(where)
                             << ", z = " << z << ", gamma = " << gamma << ", " << free.size() << " free") {
            BOOST_TEST(found.converged);
            BOOST_TEST(found.loss <= 1e-26);
            const double off = std::abs(found.theta[1] - expected);
            BOOST_TEST(off <= (free.size() == 1 ? tolerance(loss, found, z) : 1e-12));
            BOOST_TEST(std::abs(found.theta[0] - 0.5) <= (free.size() == 1 ? 0.0 : 1e-12));
          }
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(mclachlans_and_two_halves_are_elsewhere) {
  const auto loss = law_of(placement::symmetric, 1.0, 1.65);
  const Eigen::VectorXd mclachlan = column_of(nystrom::start());
  const auto found = best(loss, {1});
  BOOST_TEST(std::abs(found.theta[1] - mclachlan[1]) > 1e6 * tolerance(loss, found, 1.65));
  BOOST_TEST(loss(mclachlan).value > 1e-2);
  BOOST_TEST(loss(Eigen::Vector2d(0.5, 0.375)).value > 1e-2);
}

BOOST_AUTO_TEST_CASE(an_unstable_start_is_rejected) {
  const auto loss = law_of(placement::symmetric, 1.0, 2.75);
  const Eigen::VectorXd mclachlan = column_of(nystrom::start());
  BOOST_TEST(!loss(mclachlan).is_finite());
  BOOST_TEST(loss(Eigen::Vector2d(0.5, 0.375)).is_finite());
}

// With O in the middle it is two half steps that err least: a step of each is as BAOAB with half the step,
// whose momenta have (z/2)^2/4 of their variance too little, in three modes. That is the loss.
BOOST_AUTO_TEST_CASE(in_the_middle_no_two_stages_are_exact) {
  for (const double z : {0.5, 1.65, 2.75}) {
    const auto loss = law_of(placement::middle, 0.01, z);
    const auto found = best(loss, {1});
    BOOST_TEST(std::abs(found.theta[1] - 0.375) <= 1e-8);
    const double of_baoab = 3.0 * std::pow(z * z / 16.0, 2);
    BOOST_TEST(std::abs(found.loss - of_baoab) <=
               1e-9 * of_baoab);  // beta1 to 1e-8, twice, times a curvature
  }
}
