// SPDX-License-Identifier: BSL-1.0
// The null model, and how long trajectories can be predicted.
#include "nysalt/analysis/predictability.hpp"

#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <vector>

#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/error_measures/path.hpp"
#include "nysalt/analysis/error_measures/state.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/ensembles/gibbs_of_modes.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using star = phase_point<double, 2>;
const harmonic_oscillator oscillator(3.0);
const henon_heiles galaxy;

/// 16 stars of one energy. Near 1/6 nearly all orbits are chaotic; far below it nearly none.
std::vector<star> stars(double energy) {
  std::vector<star> result;
  for (int m = 0; m < 16; ++m) {
    star x{{0.0, 0.1 - 0.02 * m}, {0.0, 0.0}};
    const double speed = std::sqrt(2.0 * (energy - galaxy.potential<double>(x.q)));
    x.p = {speed * std::cos(0.8), speed * std::sin(0.8)};
    result.push_back(x);
  }
  return result;
}

constexpr double interval = 0.25;
const fine_steps<> flow(interval);
const model of_galaxy(galaxy);

/// The flow over an interval.
void advance(star& x) {
  static const detail::reference_value value(detail::reference_of(of_galaxy, flow));
  static const auto flowing = value.prepare<double>(of_galaxy, interval);
  phase_point<double, Eigen::Dynamic> y{x.q, x.p};
  flowing->advance(y, 1, {}, {});
  x = {y.q, y.p};
}

double horizon(const std::vector<star>& starts, double perturbation, std::int64_t steps) {
  const trajectory_options options{
      .step = interval, .steps = steps, .trajectories = std::ssize(starts), .perturbation = perturbation};
  const auto result =
      trajectory_errors(galaxy, flow, listed<2>(starts), verlet(), state_measure(galaxy), options);
  return result.predictable_until.value();
}

double squared_distance(const star& a, const star& b) {
  return (a.q - b.q).squaredNorm() + (a.p - b.p).squaredNorm();
}

/// The mean rate at which distances grow over that many samples, drawn in to 1e-8 after each.
double growth_rate(const std::vector<star>& starts, int samples) {
  double sum = 0.0;
  for (star x : starts) {
    star y = x;
    y.q[0] += 1e-8;
    for (int n = 0; n < samples; ++n) {
      advance(x);
      advance(y);
      const double growth = std::sqrt(squared_distance(x, y)) / 1e-8;
      sum += std::log(growth);
      y = {x.q + (y.q - x.q) / growth, x.p + (y.p - x.p) / growth};
    }
  }
  return sum / (static_cast<double>(starts.size()) * samples * interval);
}

}  // namespace

// States turn by w t: e^2 = 2 H |1 - exp(i w t)|^2 = 4 H (1 - cos w t).
BOOST_AUTO_TEST_CASE(an_oscillator_that_stays_has_the_error_of_its_turn) {
  const gibbs_of_modes<1> law(oscillator, 1.0);
  const trajectory_options options{.step = .1, .steps = 70, .trajectories = 30, .null_model = true};
  double expected = 0.0;
  for (std::uint64_t m = 0; m < 30; ++m) {
    for (int n = 1; n <= 70; ++n) {
      expected += 4.0 * energy<double>(oscillator, law(1, m)) * (1.0 - std::cos(.3 * n)) / (30.0 * 70.0);
    }
  }
  const auto result = trajectory_errors(oscillator, exact_linear(oscillator), law, verlet(),
                                        state_measure(oscillator), options);
  // Each of 70 turns rounds some ten times.
  BOOST_TEST(result.null_model.value().mean == std::sqrt(expected), boost::test_tools::tolerance(700 * eps));
  BOOST_TEST(result.null_model.value().standard_error > 0.0);
  BOOST_TEST(result.methods[0].error.mean < 0.5 * result.null_model->mean);
  BOOST_TEST(!result.predictable_until.has_value());
}

BOOST_AUTO_TEST_CASE(an_oscillator_is_predictable_for_ever) {
  const gibbs_of_modes<1> law(oscillator, 1.0);
  const auto until = [&](double perturbation) {
    const trajectory_options options{
        .step = .1, .steps = 300, .trajectories = 20, .perturbation = perturbation};
    const auto result = trajectory_errors(oscillator, exact_linear(oscillator), law, verlet(),
                                          state_measure(oscillator), options);
    BOOST_TEST(!result.null_model.has_value());
    return result.predictable_until.value();
  };
  BOOST_TEST(std::isinf(until(1e-6)));
  BOOST_TEST(std::isinf(until(1e-3)));
  BOOST_TEST(until(10.0) == .1);  // it is another trajectory from the start
}

// A distance d grows as exp(rate t), so that ten times as much is there log(10)/rate earlier; over tens of
// time units rates scatter, by a third or so.
BOOST_AUTO_TEST_CASE(chaos_ends_predictability_earlier_for_larger_perturbations) {
  const auto chaotic = stars(0.165);
  const double rate = growth_rate(chaotic, 1000);
  const double decade = std::log(10.0) / rate;
  double earlier = horizon(chaotic, 1e-9, 1600);
  BOOST_TEST(std::isfinite(earlier));
  for (const double perturbation : {1e-6, 1e-3}) {
    const double later = horizon(chaotic, perturbation, 1600);
    BOOST_TEST(earlier - later == 3.0 * decade, boost::test_tools::tolerance(0.5));
    earlier = later;
  }
  BOOST_TEST(std::isinf(horizon(chaotic, 1e-9, 100)));  // it has not come to that
  const auto regular = stars(0.03);
  BOOST_TEST(growth_rate(regular, 1000) < 0.2 * rate);
  BOOST_TEST(std::isinf(horizon(regular, 1e-3, 1600)));
}

/// The definition once more, over one trajectory, with what measures say of single states.
BOOST_AUTO_TEST_CASE(the_horizon_is_where_the_sums_cross) {
  const auto start = stars(0.165)[3];
  star x = start;
  star y = perturbed(start, 1e-3, 1, 0);
  double perturbed_sum = 0.0;
  double null_sum = 0.0;
  double expected = 0.0;
  for (int n = 1; n <= 1600; ++n) {
    advance(x);
    advance(y);
    perturbed_sum += squared_distance(x, y);
    null_sum += squared_distance(x, start);
    if (perturbed_sum <= 0.25 * null_sum) expected = (n + 1) * interval;
  }
  BOOST_TEST(horizon({start}, 1e-3, 1600) == expected);
  BOOST_TEST(horizon({start}, 1e-4, 1600) != expected);
}

// With noise of its own the perturbed run would be elsewhere after 1/friction = 2.
BOOST_AUTO_TEST_CASE(in_a_bath_the_noise_is_common) {
  const model warm = model(oscillator).in(bath::of_sigma(0.5, 1.0));
  const initial_states law = normal_around<1>({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.3, 1.0);
  const trajectory_options options{.step = .1, .steps = 200, .trajectories = 20, .perturbation = 1e-3};
  const auto result =
      trajectory_errors(warm, fine_paths(.05), law, tabulated(baoab()), state_measure(warm), options);
  BOOST_TEST(std::isinf(result.predictable_until.value()));
}

// At rest q moves by (w h)^2/2 = 5e-9 in a step, less than the perturbation; that does not end it.
BOOST_AUTO_TEST_CASE(a_turning_point_is_no_end) {
  const listed<1> at_rest({{vector<double, 1>(1.0), vector<double, 1>(0.0)}});
  const auto measure = path_measure(oscillator, over_lanes([](const auto& x) { return x.q[0] + 2.0; }));
  const auto until = [&](std::int64_t steps) {
    const trajectory_options options{
        .step = 1e-4 / 3.0, .steps = steps, .trajectories = 1, .perturbation = 1e-6};
    return trajectory_errors(oscillator, exact_linear(oscillator), at_rest, verlet(), measure, options)
        .predictable_until.value();
  };
  BOOST_TEST(std::isinf(until(1000)));
  BOOST_TEST(until(5) == 1e-4 / 3.0);  // here it would be
}

BOOST_AUTO_TEST_CASE(samples_count_from_where_the_errors_stay_above) {
  predictable_samples<double> squares(averaging::root_of_all);
  predictable_samples<double> moduli(averaging::mean);
  const std::array<double, 5> sums{1.0, 2.0, 3.0, 4.0, NAN};
  const std::array<double, 5> null_sums{0.0, 8.0, 8.0, 8.0, 8.0};
  std::vector<double> of_squares;
  std::vector<double> of_moduli;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    squares.add(static_cast<std::int64_t>(i) + 1, sums[i], null_sums[i]);
    moduli.add(static_cast<std::int64_t>(i) + 1, sums[i], null_sums[i]);
    of_squares.push_back(squares.until(0));
    of_moduli.push_back(moduli.until(0));
  }
  BOOST_TEST(of_squares == (std::vector<double>{1.0, INFINITY, 3.0, 3.0, 3.0}));
  BOOST_TEST(of_moduli == (std::vector<double>{1.0, INFINITY, INFINITY, INFINITY, 5.0}));
}

// 2000 relative changes, each normal: their mean square is known to sqrt(2/2000) = 3 %.
BOOST_AUTO_TEST_CASE(perturbations_are_relative_and_independent) {
  const star x{{2.0, 0.0}, {-1e-3, 1e3}};
  double squares = 0.0;
  double products = 0.0;
  for (std::uint64_t m = 0; m < 1000; ++m) {
    const star y = perturbed(x, 0.01, seed(1), m);
    BOOST_TEST(y.q[1] == 0.0);
    const double a = (y.p[0] / x.p[0] - 1.0) / 0.01;
    const double b = (y.q[0] / x.q[0] - 1.0) / 0.01;
    squares += a * a + b * b;
    products += a * b;
  }
  const double allowed = standard_errors(false_alarms / 2);
  BOOST_TEST(std::abs(squares / 2000.0 - 1.0) < allowed * std::sqrt(2.0 / 2000.0));
  BOOST_TEST(std::abs(products / 1000.0) < allowed / std::sqrt(1000.0));
  BOOST_TEST(perturbed(x, 0.01, 1, 0).q[0] != perturbed(x, 0.01, 2, 0).q[0]);
  // Not with the numbers of a start: else what is far out would move far.
  const normal_around<2> law({{1.0, 1.0}, {1.0, 1.0}}, 0.01, 0.01);
  const star ones{{1.0, 1.0}, {1.0, 1.0}};
  BOOST_TEST(perturbed(ones, 0.01, 1, 5).q[0] != law(1, 5).q[0]);
}
