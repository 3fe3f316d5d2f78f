// SPDX-License-Identifier: BSL-1.0
// Ellipses are those that were asked for, met at times that are uniform.
#include "nysalt/ensembles/kepler_law.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/energy.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::uint64_t count = 20'000;

/// Towards the pericentre, of length e: p x L - q/|q|.
vector<double, 2> eccentricity_vector(const phase_point<double, 2>& x) {
  const double angular = x.q[0] * x.p[1] - x.q[1] * x.p[0];
  return vector<double, 2>(x.p[1] * angular, -x.p[0] * angular) - x.q / x.q.norm();
}

/// Some 30 roundings, of terms as large as 1/|q| <= 1/(1 - e).
double rounding(double e) { return 30.0 * eps / (1.0 - e); }

}  // namespace

BOOST_AUTO_TEST_CASE(the_ellipses_have_axis_1_and_the_eccentricity) {
  for (const double e : {0.0, 0.3, 0.6, 0.95}) {
    const kepler_law law(e);
    for (std::uint64_t n = 0; n < 100; ++n) {
      const auto x = law(3, n);
      const double angular = x.q[0] * x.p[1] - x.q[1] * x.p[0];
      BOOST_TEST(std::abs(energy<double>(kepler(), x) + 0.5) <= rounding(e));
      BOOST_TEST(std::abs(angular - std::sqrt(1.0 - e * e)) <= rounding(e));  // counterclockwise
      BOOST_TEST(std::abs(eccentricity_vector(x).norm() - e) <= rounding(e));
    }
  }
}

// Means over time: of r 1 + e^2/2, of r^2 1 + 3 e^2/2. Over E, uniform, they were 1 and 1 + e^2/2.
BOOST_AUTO_TEST_CASE(times_are_uniform) {
  for (const double e : {0.6, 0.95}) {
    const kepler_law law(e);
    std::vector<double> radius;
    for (std::uint64_t n = 0; n < count; ++n) radius.push_back(law(seed(1), n).q.norm());
    const double deviation = std::sqrt(1.0 + 1.5 * e * e - std::pow(1.0 + 0.5 * e * e, 2));
    const double allowed = standard_errors(false_alarms / 2);
    BOOST_TEST(mean_off(radius, 1.0 + 0.5 * e * e, deviation) <= allowed);
    BOOST_TEST(mean_off(radius, 1.0, deviation) > allowed);
  }
}

BOOST_AUTO_TEST_CASE(orientations_are_uniform_and_independent_of_times) {
  const kepler_law law(0.6);
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> in_or_out;  // the radial velocity: 0 in the mean
  for (std::uint64_t n = 0; n < count; ++n) {
    const auto start = law(seed(2), n);
    const vector<double, 2> axis = eccentricity_vector(start) / 0.6;
    x.push_back(axis[0]);
    y.push_back(axis[1]);
    in_or_out.push_back(start.q.dot(start.p));
  }
  const double deviation = std::sqrt(0.5);  // of a cosine
  const double root = std::sqrt(static_cast<double>(count));
  const double allowed = standard_errors(false_alarms / 5);
  BOOST_TEST(mean_off(x, 0.0, deviation) <= allowed);
  BOOST_TEST(mean_off(y, 0.0, deviation) <= allowed);
  BOOST_TEST(std::abs(correlation(x, y)) * root <= allowed);
  BOOST_TEST(std::abs(correlation(x, in_or_out)) * root <= allowed);
  BOOST_TEST(std::abs(mean(in_or_out)) * root <= allowed * std::sqrt(covariance(in_or_out, in_or_out)));
}

BOOST_AUTO_TEST_CASE(a_start_is_a_function_of_seed_and_number) {
  const kepler_law law(0.6);
  BOOST_TEST(same_bits(law(5, 7), law(5, 7)));
  BOOST_TEST(!same_bits(law(5, 7), law(5, 8)));
  BOOST_TEST(!same_bits(law(5, 7), law(6, 7)));
  BOOST_TEST(law.description() == "kepler_law(eccentricity=0.6)");
}

BOOST_AUTO_TEST_CASE(what_is_no_ellipse_is_refused) {
  for (const double e : {1.0, -0.1, 2.0, std::numeric_limits<double>::quiet_NaN()}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { kepler_law{e}; }, {"eccentricity", "below 1"}));
  }
}
