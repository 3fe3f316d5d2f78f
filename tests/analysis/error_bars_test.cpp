// SPDX-License-Identifier: BSL-1.0
// Error bars hold what they promise: over a thousand ensembles of a law whose numbers are known.
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/ensemble_statistics.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/analysis/threshold.hpp"
#include "nysalt/analysis/total_variation.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

using namespace nysalt;

namespace {

constexpr int ensembles = 1000;
constexpr int trajectories = 50;
constexpr int steps = 10;
constexpr double factor = 1.96;

/// Eight oscillators of frequency 1. Starts are normal, of variance 1.
struct oscillators {
  static constexpr int dimension = 8;
  template <class T>
  void force(const vector<T, 8>& q, vector<T, 8>& f) const {
    for (Eigen::Index i = 0; i < 8; ++i) f[i] = -q[i];
  }
  std::string description() const { return "eight oscillators"; }
};
const oscillators all;
const normal_around<8> law({vector<double, 8>::Zero(), vector<double, 8>::Zero()}, 1.0, 1.0);

/// Their exact flow, a rotation.
struct exact_turn {
  template <class T>
  void advance(const oscillators&, phase_point<T, 8>& x, double t) const {
    const phase_point<T, 8> old = x;
    for (Eigen::Index i = 0; i < 8; ++i) {
      x.q[i] = old.q[i] * std::cos(t) + old.p[i] * std::sin(t);
      x.p[i] = old.p[i] * std::cos(t) - old.q[i] * std::sin(t);
    }
  }
  exact_turn finer() const { return {}; }
  std::string description() const { return "the exact turn"; }
};

/// The mean of |dq_i| over oscillators, trajectories and times.
error_measure modulus_measure() {
  error_measure result = state_measure(all);
  result.how = averaging::mean;
  result.error = []<class T>(std::span<const T> seen, std::span<const T> expected) {
    using std::abs;
    T sum(0.0);
    for (std::size_t i = 0; i < 8; ++i) sum += abs(seen[i] - expected[i]);
    return sum * 0.125;
  };
  return result;
}

/// exact^n - Verlet^n for n = 1, 2, ..., at a step h, of one oscillator.
std::vector<Eigen::Matrix2d> deviations(double h) {
  const Eigen::Matrix2d exact{{std::cos(h), std::sin(h)}, {-std::sin(h), std::cos(h)}};
  const double half = 1.0 - h * h / 2.0;
  const Eigen::Matrix2d verlet_step{{half, h}, {-h * (1.0 - h * h / 4.0), half}};
  Eigen::Matrix2d a = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d b = a;
  std::vector<Eigen::Matrix2d> result;
  for (int n = 0; n < steps; ++n) {
    a = exact * a;
    b = verlet_step * b;
    result.push_back(a - b);
  }
  return result;
}
double expected_state_error(double h) {
  double sum = 0.0;
  for (const auto& d : deviations(h)) sum += 8.0 * d.squaredNorm() / steps;
  return std::sqrt(sum);
}
/// The mean modulus of a normal number is sqrt(2/pi) deviations.
double expected_modulus(double h) {
  double sum = 0.0;
  for (const auto& d : deviations(h)) sum += d.row(0).norm() / steps;
  return std::sqrt(2.0 / std::numbers::pi) * sum;
}

/// How often the bar of that many standard errors covers what is true, and half of it.
struct coverage {
  int whole = 0;
  int half = 0;

  void count(const estimate& measured, double truth) {
    const double off = std::abs(measured.mean - truth) / measured.standard_error;
    if (off <= factor) ++whole;
    if (off <= 0.5 * factor) ++half;
  }
};

/// P(|x| <= factor) of a mean of m scores divided by its standard error, to the order 1/m, by their skewness
/// and excess kurtosis: 2 F(z) - 1 + 2 f(z) z ((kurtosis/12)(z^2 - 3) - (skewness^2/18)(z^4 + 2 z^2 - 3) -
/// (z^2 + 1)/4)/m, Edgeworth's expansion of Student's ratio. Without both the ratio is Student's own.
double expected_coverage(double z, double m, double skewness = 0.0, double kurtosis = 0.0) {
  const double z2 = z * z;
  const double f = std::exp(-0.5 * z2) / std::sqrt(2.0 * std::numbers::pi);
  const double by_shape = kurtosis / 12.0 * (z2 - 3.0) -
                          skewness * skewness / 18.0 * (z2 * z2 + 2.0 * z2 - 3.0) - (z2 + 1.0) / 4.0;
  return std::erf(z / std::numbers::sqrt2) + 2.0 * f * z * by_shape / m;
}

/// Within what the normal distribution allows one of five counts.
bool is_near(int count, double expected, double more = 0.0) {
  const double deviation = std::sqrt(expected * (1.0 - expected) / ensembles);
  const double found = static_cast<double>(count) / ensembles;
  BOOST_TEST_MESSAGE("covers " << found << ", expected " << expected);
  return std::abs(found - expected) < test::standard_errors(test::false_alarms / 5) * deviation + more;
}

}  // namespace

// A score is a quadratic form in 16 normal numbers, nearly the sum of their squares: skewness sqrt(8/16) and
// excess kurtosis 12/16, and a deviation of sqrt(2/16) of the mean. The root of the mean bends by a quarter
// of the relative error, whose square is 1/(8 m): less than .005. Rows share their starts, hence their
// chance: then the crossing is as uncertain as either.
BOOST_AUTO_TEST_CASE(bars_of_errors_and_of_their_crossing_cover) {
  const std::array<double, 2> h{0.2, 0.4};
  const std::vector measures{state_measure(all), modulus_measure()};
  const std::array state_errors{expected_state_error(h[0]), expected_state_error(h[1])};
  const double level = std::sqrt(state_errors[0] * state_errors[1]);
  const std::array truths{error_at{h[0], state_errors[0], 0.0}, error_at{h[1], state_errors[1], 0.0}};
  const double crossing = threshold(truths, level).x;
  coverage state;
  coverage modulus;
  coverage crossed;
  coverage as_if_independent;
  for (int n = 0; n < ensembles; ++n) {
    std::vector<error_at> rows;
    for (const double step : h) {
      const trajectory_options options{.step = step,
                                       .steps = steps,
                                       .trajectories = trajectories,
                                       .seed = test::seed(static_cast<std::uint64_t>(n))};
      const auto found = trajectory_errors(all, exact_turn(), law, verlet(), std::span(measures), options);
      const estimate error = found[0].methods[0].error;
      rows.push_back({step, error.mean, error.standard_error});
      if (step != h[0]) continue;
      state.count(error, state_errors[0]);
      modulus.count(found[1].methods[0].error, expected_modulus(step));
    }
    const auto dependent = threshold(rows, level, 1.0);
    const auto independent = threshold(rows, level);
    crossed.count({dependent.x, dependent.standard_error}, crossing);
    as_if_independent.count({independent.x, independent.standard_error}, crossing);
  }
  const double of_squares = expected_coverage(factor, trajectories, std::sqrt(0.5), 0.75);
  const double of_half = expected_coverage(0.5 * factor, trajectories, std::sqrt(0.5), 0.75);
  BOOST_TEST(is_near(state.whole, of_squares, 0.005));
  BOOST_TEST(is_near(state.half, of_half, 0.005));
  BOOST_TEST(!is_near(state.half, of_squares, 0.005));
  // Moduli are less skew than that.
  BOOST_TEST(is_near(modulus.whole, expected_coverage(factor, trajectories), 0.005));
  BOOST_TEST(!is_near(modulus.half, expected_coverage(factor, trajectories), 0.005));
  BOOST_TEST(is_near(crossed.whole, of_squares, 0.005));
  BOOST_TEST(!is_near(crossed.half, of_squares, 0.005));
  // In the middle between both rows: too small by sqrt 2.
  BOOST_TEST(
      is_near(as_if_independent.whole, expected_coverage(factor / std::numbers::sqrt2, trajectories), 0.01));
  BOOST_TEST(!is_near(as_if_independent.whole, of_squares, 0.005));
}

// Time means of a linear observable along a linear map are normal: Student's ratio exactly, of mean 0.
BOOST_AUTO_TEST_CASE(bars_of_means_cover) {
  const auto position = over_lanes([](const auto& x) { return x.q[0]; });
  const auto stepper = make_stepper(all, verlet(), 0.4);
  coverage found;
  for (std::uint64_t n = 0; n < ensembles; ++n) {
    const ensemble_options options{.trajectories = trajectories, .steps = steps, .seed = test::seed(n)};
    found.count(ensemble_statistics(stepper, law, options, position, {.moments = true}).mean, 0.0);
  }
  BOOST_TEST(is_near(found.whole, expected_coverage(factor, trajectories - 1)));
  BOOST_TEST(is_near(found.half, expected_coverage(0.5 * factor, trajectories - 1)));
  BOOST_TEST(!is_near(found.half, expected_coverage(factor, trajectories - 1)));
}

namespace {

constexpr int samples = 256;  // in 64 groups of 4

/// Histograms of starts of one oscillator, normal around a mean.
std::vector<histogram> groups_around(double mean, std::uint64_t number, const equal_bins& bins) {
  static const harmonic_oscillator oscillator(1.0);
  static const auto stepper = make_stepper(oscillator, verlet(), 0.1);
  const auto position = over_lanes([](const auto& x) { return x.q[0]; });
  const normal_around<1> starts({vector<double, 1>(mean), vector<double, 1>(0.0)}, 1.0, 0.0);
  const ensemble_options options{.trajectories = samples, .steps = 0, .seed = test::seed(number)};
  return ensemble_statistics(stepper, starts, options, position, {.histogram = bins}).histogram_of_groups;
}

double normal_law(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// Fractions p, q of n samples each: p - q is nearly normal, and of a normal number of mean d and deviation s
/// the modulus has the mean s sqrt(2/pi) exp(-d^2/2 s^2) + d erf(d/(s sqrt 2)).
double expected_distance(double mean, const equal_bins& bins) {
  std::vector<double> edges{-1e300};
  for (int k = 0; k <= bins.count; ++k) edges.push_back(bins.low + k * bins.width());
  edges.push_back(1e300);
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    const double p = normal_law(edges[k + 1] - mean) - normal_law(edges[k] - mean);
    const double q = normal_law(edges[k + 1] + mean) - normal_law(edges[k] + mean);
    const double d = p - q;
    const double s = std::sqrt((p * (1.0 - p) + q * (1.0 - q)) / samples);
    sum += s * std::sqrt(2.0 / std::numbers::pi) * std::exp(-0.5 * d * d / (s * s));
    sum += d * std::erf(d / (s * std::numbers::sqrt2));
  }
  return 0.5 * sum;
}

}  // namespace

// Laws .6 to both sides: in each of the bins the sign of p - q is all but certain. Two jackknives of 64
// groups have 126 degrees of freedom. Counts near 10 in the outer bins are a little skew.
BOOST_AUTO_TEST_CASE(bars_of_distances_cover) {
  const equal_bins bins{-2.0, 2.0, 4};
  const double expected = expected_distance(0.6, bins);
  coverage found;
  for (std::uint64_t n = 0; n < ensembles; ++n) {
    const std::vector<std::vector<histogram>> other{groups_around(-0.6, 2 * n, bins)};
    found.count(mean_total_variation(groups_around(0.6, 2 * n + 1, bins), other), expected);
  }
  BOOST_TEST(is_near(found.whole, expected_coverage(factor, 126.0), 0.005));
  BOOST_TEST(is_near(found.half, expected_coverage(0.5 * factor, 126.0), 0.005));
  BOOST_TEST(!is_near(found.half, expected_coverage(factor, 126.0), 0.005));
}

// Of one law: distances scatter by sqrt(1 - 2/pi) = .60 of what they say, known to 1/sqrt(2 x 400) = 3.5 %.
// Bins of shares p are correlated by -sqrt(p_i p_j): the variance of the scatter grows by (sum of p^1.5)^2/pi
// = .011 of .363, that of the bar shrinks by the sum of p^2 = .038, and the ratio grows by 3.4 %; the next
// order is smaller.
BOOST_AUTO_TEST_CASE(bars_at_the_floor_are_too_long) {
  const equal_bins bins{-2.0, 2.0, 30};
  std::vector<double> distances;
  double said = 0.0;
  for (std::uint64_t n = 0; n < 400; ++n) {
    const std::vector<std::vector<histogram>> other{groups_around(0.0, 2 * n, bins)};
    const estimate distance = mean_total_variation(groups_around(0.0, 2 * n + 1, bins), other);
    distances.push_back(distance.mean);
    said += distance.standard_error / 400.0;
  }
  const double scatter = mean_and_error(distances).standard_error * std::sqrt(400.0);
  const auto near = boost::test_tools::tolerance(test::standard_errors(test::false_alarms) * .04 + .05);
  BOOST_TEST(scatter == std::sqrt(1.0 - 2.0 / std::numbers::pi) * said, near);
  BOOST_TEST(scatter != said, near);
}
