// SPDX-License-Identifier: BSL-1.0
// Errors have an expectation: more trajectories say the same, or the tail is told.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/error_measures/energy.hpp"
#include "nysalt/analysis/error_measures/path.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/pendulum.hpp"

using namespace nysalt;

namespace {

/// Every coordinate uniform in [-bound, bound]: errors of normal ones are so skew (10) that a mean of 1000 is
/// five of its standard errors off once in 4000 times.
template <int N>
struct uniform_within {
  double bound;

  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    const vector<double, N> zero = vector<double, N>::Zero();
    auto start = normal_around<N>({zero, zero}, 1.0, 1.0)(seed, n);
    for (auto* x : {&start.q, &start.p}) {
      for (double& value : *x) value = bound * std::erf(value / std::numbers::sqrt2);
    }
    return start;
  }
  std::string description() const { return "uniform"; }
};

const pendulum swing;
const uniform_within<1> swings{0.8};
const normal_around<1> normal_swings({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.5, 0.5);
const henon_heiles galaxy;
const uniform_within<2> stars{0.15};

/// Errors of Verlet at 10^3, ... trajectories, of other starts each.
template <System S>
std::vector<method_error> at_numbers(const S& system, const Ensemble<S> auto& law,
                                     const error_measure& measure) {
  std::vector<method_error> result;
  std::uint64_t number = 10;
  for (const std::int64_t count : {1'000, 10'000, 40'000}) {
    const trajectory_options options{
        .step = 0.2, .steps = 20, .trajectories = count, .seed = test::seed(++number)};
    result.push_back(
        trajectory_errors(system, fine_steps<>(0.05), law, verlet(), measure, options).methods[0]);
  }
  return result;
}

/// Of each pair, the difference in standard errors of both; the largest.
double farthest(const std::vector<method_error>& all) {
  double worst = 0.0;
  for (const auto& a : all) {
    for (const auto& b : all) {
      if (&a == &b) continue;
      const double apart = std::abs(a.error.mean - b.error.mean);
      worst = std::max(worst, apart / std::hypot(a.error.standard_error, b.error.standard_error));
    }
  }
  return worst;
}

}  // namespace

// Five times three pairs. A mean of n numbers of skewness g is z of its estimated standard errors off more
// often than a normal one by exp(g z^3/(3 sqrt(n))), to one side; g is 1.1 here, or less, of 10^6
// trajectories: a factor of 6.
BOOST_AUTO_TEST_CASE(errors_do_not_grow_with_the_number_of_trajectories) {
  const double allowed = test::standard_errors(test::false_alarms / (15 * 6));
  const auto q = [](const auto& x) { return x.q[0]; };
  BOOST_TEST(farthest(at_numbers(swing, swings, energy_measure(swing))) < allowed);
  BOOST_TEST(farthest(at_numbers(swing, swings, path_measure(swing, q))) < allowed);
  BOOST_TEST(farthest(at_numbers(galaxy, stars, path_measure(galaxy, q))) < allowed);
  BOOST_TEST(farthest(at_numbers(galaxy, stars, energy_measure(galaxy))) < allowed);
  BOOST_TEST(farthest(at_numbers(galaxy, stars, state_measure(galaxy))) < allowed);
}

// The energy of the pendulum at the start passes through 0: relative to each by itself, the mean square does
// not exist: all of these errors have a tail, and the mean is far above what half of the trajectories err by.
BOOST_AUTO_TEST_CASE(an_error_relative_to_what_passes_through_zero_has_none) {
  error_measure measure = energy_measure(swing);
  measure.relative_to = {};
  measure.error = [](auto seen, auto at_start) {
    const auto relative = (seen[0] - at_start[0]) / at_start[0];
    return relative * relative;
  };
  const auto all = at_numbers(swing, normal_swings, measure);
  for (const auto& result : all) BOOST_TEST(result.spread.largest.is_heavy());
  BOOST_TEST(all.back().error.mean > 3.0 * all.back().spread.median.mean);
  // As a scale the energy would be refused: -1 + p^2/2 + ... is of both signs.
  measure.scale = [](auto at_start) { return at_start[0]; };
  measure.no_scale = "of both signs";
  BOOST_CHECK_THROW(at_numbers(swing, normal_swings, measure), std::invalid_argument);
}

// The median of each size is that of the largest, whatever the tail. The place of a median of n among N other
// errors is 1/2 with the deviation sqrt(1/n + 1/N)/2, for any distribution. Its standard error would not do
// as a unit here: it is uncertain by n^(-1/4), which makes five of them no rare event.
BOOST_AUTO_TEST_CASE(medians_need_no_moment) {
  const auto all = at_numbers(swing, normal_swings, state_measure(swing));
  const auto& largest = all.back().own;
  for (const auto& a : all) {
    BOOST_TEST(a.spread.quantiles[2] == a.spread.median.mean);
    BOOST_TEST(a.spread.quantiles[0] < a.spread.quantiles[2]);
    BOOST_TEST(a.spread.quantiles[2] < a.spread.quantiles[4]);
    const auto below = std::ranges::count_if(largest, [&](double x) { return x < a.spread.median.mean; });
    const auto n = static_cast<double>(a.own.size());
    const auto of_largest = static_cast<double>(largest.size());
    const double deviation = 0.5 * std::sqrt(1.0 / n + 1.0 / of_largest);
    BOOST_TEST(std::abs(static_cast<double>(below) / of_largest - 0.5) <=
               test::standard_errors(test::false_alarms / 2) * deviation);
  }
}
