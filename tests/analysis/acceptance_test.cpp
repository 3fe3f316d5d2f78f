// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 1.0 s at -O0, 0.2 s at -O1.
// The acceptance of proposals of Hybrid Monte Carlo: in closed form, and along trajectories.
#include "nysalt/analysis/acceptance.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/gaussian_acceptance.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/gibbs_of_modes.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/free_composition.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
const fpu_chain<3> chain(50.0);
const model of_chain(chain);
const fpu_law<3> law(chain);
const tabulated by_verlet{verlet{}};
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The mean of min(1, exp(-x)) over x normal of mean mu and variance 2 mu, by the midpoint rule.
double accepted(double mu) {
  constexpr int points = 200'000;
  constexpr double reach = 8.0;  // deviations: beyond lies 1e-15
  const double deviation = std::sqrt(2.0 * mu);
  double sum = 0.0;
  for (int k = 0; k < points; ++k) {
    const double u = reach * (2.0 * (k + 0.5) / points - 1.0);
    const double x = mu + deviation * u;
    sum += std::exp(-0.5 * u * u) * std::min(1.0, std::exp(-x));
  }
  return sum * 2.0 * reach / points / std::sqrt(2.0 * std::numbers::pi);
}

/// On the oscillator n steps are a linear map of determinant 1. In (omega q, p)/sqrt(kT) it has singular
/// values s and 1/s, and a start of the Gibbs law is two standard normals (u, v) along its axes:
/// (H' - H)/kT = ((s^2 - 1) u^2 - (1 - s^-2) v^2)/2 falls where |u/v| < 1/s, with the probability
/// (2/pi) arctan(1/s). A reversible map that keeps volume accepts twice as often as it loses energy.
double expected(const model& system, double omega, const tabulated& method, double step, std::int64_t steps) {
  const auto image = [&](double x, double p) {
    const phase_point<double, Eigen::Dynamic> at{Eigen::VectorXd::Constant(1, x / omega),
                                                 Eigen::VectorXd::Constant(1, p)};
    const auto end = integrate(system, method, step, at, steps).finish;
    return std::array{end.q[0] * omega, end.p[0]};
  };
  const auto [a, c] = image(1.0, 0.0);
  const auto [b, d] = image(0.0, 1.0);
  const double sum = a * a + b * b + c * c + d * d;  // s^2 + 1/s^2
  const double s = std::sqrt((sum + std::sqrt(sum * sum - 4.0)) / 2.0);
  return 4.0 / std::numbers::pi * std::atan(1.0 / s);
}

/// K = sqrt(1 + p^2) + tilt p + bend p^3, odd where it must not be.
struct tilted {
  static constexpr int dimension = 2;
  static constexpr int lanes = 1;
  double tilt = 0.0;
  double bend = 0.0;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    return (q[0] * q[0] + q[1] * q[1]) * 0.5;
  }
  template <class T>
  T kinetic_energy(const vector<T, 2>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + p[1] * p[1] + 1.0) + p[1] * tilt + p[1] * p[1] * p[1] * bend;
  }
};

}  // namespace

// The midpoint rule errs by the jump of the slope at x = 0 times the square of its interval, 8e-5, over 24.
BOOST_AUTO_TEST_CASE(the_acceptance_of_normal_energy_errors_is_the_mean_of_metropolis_rule) {
  for (const double mu : {1e-3, 0.0316, 0.5, 3.0}) {
    BOOST_TEST(std::abs(acceptance_at(mu) - accepted(mu)) <= 1e-9);
    BOOST_TEST(std::abs(acceptance_at(1.001 * mu) - accepted(mu)) > 1e-9);
    BOOST_TEST(energy_error_at(acceptance_at(mu)) == mu, boost::test_tools::tolerance(1e-11));
  }
  BOOST_TEST(acceptance_at(0.0) == 1.0);
  BOOST_TEST(acceptance_at(infinite) == 0.0);
}

// d oscillators of one frequency and Verlet's method: d z^4/(64 (1 - z^2/4)) = mu is quadratic in z^2. The
// step is found to 1e-9.
BOOST_AUTO_TEST_CASE(the_gaussian_step_of_verlet_is_the_closed_form) {
  const double mu = energy_error_at(0.9);
  for (const int d : {1, 100, 10'000}) {
    const std::vector<double> frequencies(static_cast<std::size_t>(d), 3.0);
    const double a = d / 64.0;
    const double b = mu / 4.0;
    const double closed = std::sqrt((-b + std::sqrt(b * b + 4.0 * a * mu)) / (2.0 * a)) / 3.0;
    const double found = gaussian_step(by_verlet, frequencies, 0.9);
    BOOST_TEST(std::abs(found / closed - 1.0) <= 2e-9);
    BOOST_TEST(std::abs(gaussian_step(by_verlet, frequencies, 0.89) / closed - 1.0) > 1e-3);
    BOOST_TEST(std::abs(gaussian_step(by_verlet, frequencies, 0.9, 5.0 * closed) / closed - 1.0) <= 2e-9);
    // Errors add up over oscillators.
    BOOST_TEST(gaussian_energy_error(by_verlet, frequencies, found) == mu,
               boost::test_tools::tolerance(1e-6));
  }
  BOOST_TEST(gaussian_energy_error(by_verlet, std::vector{1.0}, 2.5) == infinite);
}

BOOST_AUTO_TEST_CASE(the_acceptance_on_the_oscillator_is_the_closed_form) {
  constexpr double omega = 2.0;
  const harmonic_oscillator system(omega);
  const auto check = [&](const tabulated& method, double z, double temperature) {
    const trajectory_options options{
        .step = z / omega, .steps = 5, .trajectories = 8000, .seed = seed(1), .threads = 2};
    const gibbs_of_modes<1> starts(system, temperature);
    const auto found = acceptance(system, method, starts, options, temperature).probability;
    const double known = expected(system, omega, method, z / omega, options.steps);
    BOOST_TEST(known < 0.97);
    const double allowed = standard_errors(false_alarms / 3);
    BOOST_TEST(std::abs(found.mean - known) < allowed * found.standard_error);
    BOOST_TEST(found.standard_error < 0.5 / std::sqrt(8000.0));  // of numbers within [0, 1]
    const auto colder = acceptance(system, method, starts, options, 0.5 * temperature).probability;
    BOOST_TEST(known - colder.mean > allowed * colder.standard_error);
  };
  check(by_verlet, 1.0, 1.0);
  check(by_verlet, 1.5, 0.3);
  check(tabulated(bcss2()), 3.0, 2.0);
}

BOOST_AUTO_TEST_CASE(it_is_the_mean_over_trajectories_of_what_integrate_says) {
  const trajectory_options options{.step = 0.03, .steps = 70, .trajectories = 37, .seed = 3};
  const auto all = acceptance(chain, verlet(), law, options, 0.1);
  BOOST_REQUIRE(all.of_each.size() == 37U);
  double sum = 0.0;
  for (std::uint64_t m = 0; m < 37; ++m) {
    const phase_point<double, Eigen::Dynamic> start{law(options.seed, m).q, law(options.seed, m).p};
    const auto end = integrate(of_chain, by_verlet, options.step, start, options.steps).finish;
    const double rise = energy<double>(of_chain, end) - energy<double>(of_chain, start);
    const double of_one = std::min(1.0, std::exp(-rise / 0.1));
    BOOST_TEST(all.of_each[m] == of_one);
    sum += of_one;
  }
  BOOST_TEST(all.probability.mean == sum / 37.0, boost::test_tools::tolerance(1e-14));  // 37 roundings
  BOOST_TEST(all.probability.mean > 0.1);
  BOOST_TEST(all.probability.mean < 0.99);
  BOOST_TEST(all.evaluations_per_time == 71.0 / (70 * 0.03), boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(what_diverged_is_rejected) {
  const trajectory_options options{.step = 0.05, .steps = 3, .trajectories = 40};
  const auto all = acceptance(chain, verlet(), law, options);
  BOOST_TEST(all.diverged_at.size() > 0U);
  BOOST_TEST(all.diverged_at.size() < 40U);
  for (const auto& [m, step] : all.diverged_at) {
    BOOST_TEST(all.of_each[static_cast<std::size_t>(m)] == 0.0);
    const auto start = law(options.seed, static_cast<std::uint64_t>(m));
    const phase_point<double, Eigen::Dynamic> x{start.q, start.p};
    BOOST_TEST(integrate(of_chain, by_verlet, 0.05, x, 3).diverged_at.value() == step);
  }
  BOOST_TEST(!std::isnan(all.probability.mean));  // a mean of errors would leave them out
}

// With an odd K a palindrome runs back from (q, p) by -h, and not from (q, -p).
BOOST_AUTO_TEST_CASE(what_is_no_proposal_is_refused) {
  const trajectory_options options{.step = 0.01, .steps = 5, .trajectories = 3};
  const member<aba3_free> one_way(aba3_free::start());
  BOOST_TEST(refuses<wrong>([&] { acceptance(chain, one_way, law, options); },
                            {"aba3_free", "must be reversible", "symmetric"}));
  const model warm = of_chain.in(bath::of_temperature(1.0, 1.0));
  BOOST_TEST(refuses<wrong>([&] { acceptance(warm, by_verlet, initial_states(law), options); }, {"bath"}));
  const model at_rest = of_chain.in(bath::of_sigma(0.0, 0.0));
  BOOST_TEST(acceptance(at_rest, by_verlet, initial_states(law), options).of_each.size() == 3U);
  for (const double temperature : {0.0, -1.0, infinite, std::nan("")}) {
    BOOST_TEST(
        refuses<wrong>([&] { acceptance(chain, verlet(), law, options, temperature); }, {"kT", "positive"}));
  }
  BOOST_TEST(refuses<wrong>([&] { acceptance(chain, verlet(), law, {.step = 0.01, .steps = 0}); },
                            {"0 steps", "at least 1"}));

  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 1.0, 1.0);
  const auto with = [&](double tilt, double bend) {
    return acceptance(tilted{tilt, bend}, verlet(), starts, options).of_each.size();
  };
  BOOST_TEST(with(0.0, 0.0) == 3U);
  for (const auto& odd : {std::pair(1e-3, 0.0), std::pair(0.0, 1e-3), std::pair(-1.0, 0.3)}) {
    BOOST_TEST(
        refuses<wrong>([&] { with(odd.first, odd.second); }, {"kinetic energy", "even", "initial state 0"}));
  }
}

BOOST_AUTO_TEST_CASE(gaussian_targets_that_cannot_be_are_refused) {
  const std::vector<double> one{1.0};
  const std::vector<double> none{0.0};
  const std::vector<double> many(1000, 1.0);
  const tabulated& method = by_verlet;
  BOOST_TEST(refuses<wrong>([&] { gaussian_step(method, none, 0.9); }, {"a frequency must be positive"}));
  BOOST_TEST(refuses<wrong>([&] { gaussian_step(method, {}, 0.9); }, {"a frequency must be positive"}));
  for (const double acceptance : {0.0, 1.0, -1.0, std::nan("")}) {
    BOOST_TEST(refuses<wrong>([&] { gaussian_step(method, one, acceptance); }, {"between 0 and 1"}));
  }
  BOOST_TEST(
      refuses<wrong>([&] { gaussian_step(method, many, 1.0 - 1e-12); }, {"must be one that verlet reaches"}));
  BOOST_TEST(refuses<wrong>([&] { gaussian_step(tabulated(mclachlan_atela4{}), one, 0.9); },
                            {"must be reversible"}));
}
