// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 32 s at -O0, 2.5 s at -O1.
// Error bars cover as often as they promise, over a thousand ensembles of a law whose numbers are known; and
// errors have an expectation: more trajectories give the same, or the tail is reported.
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr int ensembles = 1000;
constexpr int trajectories = 50;
constexpr int steps = 10;
constexpr double factor = 1.96;

/// Eight oscillators of frequency 1. Starts are normal, of variance 1.
const model all{linear_chain(Eigen::MatrixXd::Identity(8, 8))};
const normal_around<Eigen::Dynamic> law({Eigen::VectorXd::Zero(8), Eigen::VectorXd::Zero(8)}, 1.0, 1.0);
/// One step of it errs by 1e-9 or so.
const auto flow = fine_steps(0.2);
const method by_verlet{verlet()};

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

/// Within what the normal distribution allows one of three counts.
bool is_near(int count, double expected, double more = 0.0) {
  const double deviation = std::sqrt(expected * (1.0 - expected) / ensembles);
  const double found = static_cast<double>(count) / ensembles;
  BOOST_TEST_MESSAGE("covers " << found << ", expected " << expected);
  return std::abs(found - expected) < standard_errors(false_alarms / 3) * deviation + more;
}

/// Every coordinate uniform in [-bound, bound]: errors of normal ones are so skew (10) that a mean of 1000 is
/// five of its standard errors off once in 4000 times.
struct uniform_within {
  Eigen::Index size;
  double bound;

  phase_point<double, Eigen::Dynamic> operator()(std::uint64_t seed, std::uint64_t n) const {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
    auto start = normal_around<Eigen::Dynamic>({zero, zero}, 1.0, 1.0)(seed, n);
    for (auto* x : {&start.q, &start.p}) {
      for (double& value : *x) value = bound * std::erf(value / std::numbers::sqrt2);
    }
    return start;
  }
  std::string description() const { return "uniform"; }
};

const model swing{pendulum()};
const initial_states swings = uniform_within{1, 0.8};
const initial_states normal_swings =
    normal_around<1>({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.5, 0.5);
const model galaxy{henon_heiles()};
const initial_states stars = uniform_within{2, 0.15};

/// Errors of Verlet at 10^3, ... trajectories, of other starts each.
std::vector<method_error> at_numbers(const model& system, const initial_states& starts,
                                     const error_measure& measure) {
  std::vector<method_error> result;
  std::uint64_t number = 10;
  for (const std::int64_t count : {1'000, 10'000, 40'000}) {
    const trajectory_options options{.step = 0.2, .steps = 20, .trajectories = count, .seed = seed(++number)};
    result.push_back(
        trajectory_errors(system, fine_steps(0.05), starts, by_verlet, measure, options).methods[0]);
  }
  return result;
}

/// Of each pair, the difference in standard errors of both; the largest.
double farthest(const std::vector<method_error>& some) {
  double worst = 0.0;
  for (const auto& a : some) {
    for (const auto& b : some) {
      if (&a == &b) continue;
      const double apart = std::abs(a.error.mean - b.error.mean);
      worst = std::max(worst, apart / std::hypot(a.error.standard_error, b.error.standard_error));
    }
  }
  return worst;
}

}  // namespace

// A score is a quadratic form in 16 normal numbers, nearly the sum of their squares: skewness sqrt(8/16) and
// excess kurtosis 12/16, and a deviation of sqrt(2/16) of the mean. The root of the mean bends by a quarter
// of the relative error, whose square is 1/(8 m): less than .005.
BOOST_AUTO_TEST_CASE(bars_of_errors_cover) {
  constexpr double step = 0.2;
  const std::vector measures{state_measure(all), modulus_measure()};
  coverage state;
  coverage modulus;
  for (std::uint64_t n = 0; n < ensembles; ++n) {
    const trajectory_options options{
        .step = step, .steps = steps, .trajectories = trajectories, .seed = seed(n)};
    const auto found = trajectory_errors(all, flow, law, by_verlet, std::span(measures), options);
    state.count(found[0].methods[0].error, expected_state_error(step));
    modulus.count(found[1].methods[0].error, expected_modulus(step));
  }
  const double of_squares = expected_coverage(factor, trajectories, std::sqrt(0.5), 0.75);
  const double of_half = expected_coverage(0.5 * factor, trajectories, std::sqrt(0.5), 0.75);
  BOOST_TEST(is_near(state.whole, of_squares, 0.005));
  BOOST_TEST(is_near(state.half, of_half, 0.005));
  BOOST_TEST(!is_near(state.half, of_squares, 0.005));
  // Moduli are less skew than that.
  BOOST_TEST(is_near(modulus.whole, expected_coverage(factor, trajectories), 0.005));
  BOOST_TEST(!is_near(modulus.half, expected_coverage(factor, trajectories), 0.005));
}

// Five times three pairs. A mean of n numbers of skewness g is z of its estimated standard errors off more
// often than a normal one by exp(g z^3/(3 sqrt(n))), to one side; g is 1.1 here, or less, of 10^6
// trajectories: a factor of 6.
BOOST_AUTO_TEST_CASE(errors_do_not_grow_with_the_number_of_trajectories) {
  const double allowed = standard_errors(false_alarms / (15 * 6));
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
  for (const auto& result : all) {
    BOOST_TEST(result.spread.largest.is_heavy());
    BOOST_TEST(result.spread.quantiles[2] == result.spread.median.mean);
    BOOST_TEST(result.spread.quantiles[0] < result.spread.quantiles[2]);
    BOOST_TEST(result.spread.quantiles[2] < result.spread.quantiles[4]);
  }
  BOOST_TEST(all.back().error.mean > 3.0 * all.back().spread.median.mean);
  // As a scale the energy would be refused: -1 + p^2/2 + ... is of both signs.
  measure.scale = [](auto at_start) { return at_start[0]; };
  measure.no_scale = "of both signs";
  BOOST_CHECK_THROW(at_numbers(swing, normal_swings, measure), std::invalid_argument);
}
