// SPDX-License-Identifier: BSL-1.0
// The bath's formulas, against more digits and in their limits.
#include "nysalt/bath.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/scalars/pack.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// sigma sqrt((1 - e^{-2 gamma t})/(2 gamma)) with 11 bits more than double has.
double exact_deviation(double friction, double sigma, double time) {
  const long double rate = 2.0L * friction;
  return static_cast<double>(sigma * std::sqrt(-std::expm1(-rate * time) / rate));
}

/// The formula as one would type it. For small gamma t nothing is left of 1 - e^{-2 gamma t}.
double naive_deviation(double friction, double sigma, double time) {
  return sigma * std::sqrt((1.0 - std::exp(-2.0 * friction * time)) / (2.0 * friction));
}

double relative(double x, double expected) { return std::abs(x / expected - 1.0); }

/// Log-uniform.
double some_size(draws& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

// Seven roundings, of which the root halves five; expm1 is good to a unit and damps relative errors.
BOOST_AUTO_TEST_CASE(the_deviation_has_all_its_digits) {
  draws random;
  for (int n = 0; n < 1000; ++n) {
    const double friction = some_size(random, 1e-280, 1e3);
    const double time = some_size(random, 1e-6, 1e2);
    const double sigma = some_size(random, 1e-3, 1e3);
    const auto noisy = bath::of_sigma(friction, sigma);
    BOOST_TEST_CONTEXT("friction " << friction << ", time " << time << ", seed " << draws::seed) {
      BOOST_TEST(relative(noisy.deviation(time), exact_deviation(friction, sigma, time)) <= 4.0 * eps);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_naive_formula_would_be_found_out) {
  const double exact = exact_deviation(1e-10, 1.0, 1e-3);
  BOOST_TEST(relative(naive_deviation(1e-10, 1.0, 1e-3), exact) > 1e-4);
  BOOST_TEST(naive_deviation(1e-10, 1.0, 1e-8) == 0.0);
}

BOOST_AUTO_TEST_CASE(without_friction_the_deviation_grows_as_a_random_walk) {
  const auto heating = bath::of_sigma(0.0, 0.7);
  for (const double time : {1e-8, 0.01, 3.0}) {
    BOOST_TEST(heating.deviation(time) == std::sqrt(time) * 0.7);
    BOOST_TEST(heating.decay(time) == 1.0);
    // and that is where small frictions go: sqrt(1 - gamma t) from it.
    BOOST_TEST(relative(bath::of_sigma(1e-20, 0.7).deviation(time), 0.7 * std::sqrt(time)) <= 4.0 * eps);
  }
}

BOOST_AUTO_TEST_CASE(a_long_time_forgets) {
  const auto warm = bath::of_temperature(0.5, 2.0);
  BOOST_TEST(warm.decay(1e4) == 0.0);
  BOOST_TEST(relative(warm.deviation(1e4), std::sqrt(2.0)) <= 4.0 * eps);
}

// Two times in a row are their sum: rounding of exp at arguments up to 4, and of a few products.
BOOST_AUTO_TEST_CASE(times_add_up) {
  draws random;
  for (int n = 0; n < 100; ++n) {
    const auto noisy = bath::of_sigma(random.uniform(0.01, 2.0), random.uniform(0.1, 2.0));
    const double s = random.uniform(0.01, 1.0);
    const double t = random.uniform(0.01, 1.0);
    BOOST_TEST(relative(noisy.decay(s) * noisy.decay(t), noisy.decay(s + t)) <= 16.0 * eps);
    const double of_both = std::hypot(noisy.decay(t) * noisy.deviation(s), noisy.deviation(t));
    BOOST_TEST(relative(of_both, noisy.deviation(s + t)) <= 16.0 * eps);
    const double forgetful = std::hypot(noisy.deviation(s), noisy.deviation(t));
    BOOST_TEST(relative(forgetful, noisy.deviation(s + t)) > 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(sigma_and_temperature_give_each_other) {
  draws random;
  for (int n = 0; n < 100; ++n) {
    const double friction = random.uniform(0.001, 10.0);
    const double temperature = random.uniform(0.001, 10.0);
    const auto by_temperature = bath::of_temperature(friction, temperature);
    BOOST_TEST(by_temperature.friction() == friction);
    BOOST_TEST(by_temperature.temperature() == temperature);  // as given
    BOOST_TEST(relative(by_temperature.sigma(), std::sqrt(2.0 * friction * temperature)) <= 2.0 * eps);
    const auto by_sigma = bath::of_sigma(friction, by_temperature.sigma());
    BOOST_TEST(by_sigma.sigma() == by_temperature.sigma());
    BOOST_TEST(relative(by_sigma.temperature(), temperature) <= 4.0 * eps);
    // A momentum of that temperature stays at it: a^2 kT + s^2 = kT.
    const double a = by_sigma.decay(0.3);
    const double s = by_sigma.deviation(0.3);
    BOOST_TEST(relative(a * a * temperature + s * s, temperature) <= 16.0 * eps);
  }
}

BOOST_AUTO_TEST_CASE(without_friction_there_is_no_temperature_unless_it_was_given) {
  BOOST_TEST(bath::of_sigma(0.1, 0.2).has_temperature());
  BOOST_TEST(bath::of_sigma(0.1, 0.0).temperature() == 0.0);
  BOOST_TEST(bath::of_temperature(0.0, 1.5).temperature() == 1.5);
  for (const double sigma : {0.0, 0.25}) {
    const auto undefined = bath::of_sigma(0.0, sigma);
    BOOST_TEST(!undefined.has_temperature());
    BOOST_TEST(refuses<std::domain_error>(
        [&] { undefined.temperature(); },
        {fmt::format("sigma = {}", sigma), "must be > 0 for a temperature", "friction"}));
  }
}

BOOST_AUTO_TEST_CASE(it_acts_if_there_is_friction_or_noise) {
  BOOST_TEST(!bath::of_sigma(0.0, 0.0).acts());
  BOOST_TEST(!bath::of_temperature(0.0, 1.0).acts());
  BOOST_TEST(bath::of_sigma(0.1, 0.0).acts());
  BOOST_TEST(bath::of_sigma(0.0, 0.1).acts());
  BOOST_TEST(bath::of_temperature(0.1, 0.0).acts());
  BOOST_TEST(bath::of_temperature(0.1, 0.0).deviation(0.3) == 0.0);
  BOOST_TEST(bath::of_sigma(0.0, 0.0).deviation(0.3) == 0.0);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  using wrong = std::invalid_argument;
  for (const double bad : {-1e-300, -1.0, infinite, -infinite, not_a_number}) {
    const std::string said = fmt::format("got {}", bad);
    BOOST_TEST(refuses<wrong>([&] { bath::of_sigma(bad, 1.0); }, {"bath", "friction", "negative", said}));
    BOOST_TEST(refuses<wrong>([&] { bath::of_sigma(1.0, bad); }, {"bath", "sigma", "negative", said}));
    BOOST_TEST(refuses<wrong>([&] { bath::of_temperature(bad, 1.0); }, {"bath", "friction", said}));
    BOOST_TEST(refuses<wrong>([&] { bath::of_temperature(1.0, bad); }, {"bath", "temperature", said}));
  }
  // Finite numbers whose sigma is not: 2 friction temperature is above the largest double, 1.8e308.
  for (const auto& [friction, temperature] : {std::pair(1e200, 1e150), std::pair(1e308, 1.0)}) {
    BOOST_TEST(refuses<wrong>(
        [&] { bath::of_temperature(friction, temperature); },
        {"friction and temperature", "finite product", fmt::format("{} and {}", friction, temperature)}));
  }
  BOOST_TEST(std::isfinite(bath::of_temperature(8e307, 1.0).sigma()));
}

BOOST_AUTO_TEST_CASE(it_says_what_it_is) {
  BOOST_TEST(bath::of_sigma(0.01, 0.05).description() == "bath(friction=0.01, sigma=0.05)");
}

// da/dt = -gamma a, and d(s^2)/dt = sigma^2 a^2.
BOOST_AUTO_TEST_CASE(derivatives_flow_through_it) {
  using D = dual<double, 1>;
  draws random;
  for (int n = 0; n < 50; ++n) {
    const auto noisy = bath::of_sigma(random.uniform(0.01, 2.0), random.uniform(0.1, 2.0));
    const D time = D::variable(random.uniform(0.01, 1.0), 0);
    const D a = noisy.decay(time);
    const D s = noisy.deviation(time);
    BOOST_TEST(a.value == noisy.decay(time.value));
    BOOST_TEST(s.value == noisy.deviation(time.value));
    BOOST_TEST(std::abs(a.derivative[0] + noisy.friction() * a.value) <= 4.0 * eps * noisy.friction());
    const double slope = noisy.sigma() * noisy.sigma() * a.value * a.value / (2.0 * s.value);
    BOOST_TEST(relative(s.derivative[0], slope) <= 16.0 * eps);
    const D walk = bath::of_sigma(0.0, noisy.sigma()).deviation(time);
    BOOST_TEST(relative(walk.derivative[0], 0.5 * noisy.sigma() / std::sqrt(time.value)) <= 4.0 * eps);
  }
}

BOOST_AUTO_TEST_CASE(each_lane_has_the_bits_of_double) {
  draws random;
  const auto noisy = bath::of_sigma(0.3, 0.7);
  pack<double, 5> time;
  for (int k = 0; k < 5; ++k) time.set(k, random.uniform(0.0, 1.0));
  const auto a = noisy.decay(time);
  const auto s = noisy.deviation(time);
  for (int k = 0; k < 5; ++k) {
    BOOST_TEST(a[k] == noisy.decay(time[k]));
    BOOST_TEST(s[k] == noisy.deviation(time[k]));
  }
}

// A letter O whose coefficient is 0, and stays it, has no noise and no derivative; one that moves has the
// derivative of sqrt(t), which is infinite.
BOOST_AUTO_TEST_CASE(the_deviation_of_no_time_has_the_derivative_of_its_limit) {
  using D = dual<double, 2>;
  for (const double friction : {0.0, 0.7}) {
    const auto noisy = bath::of_sigma(friction, 0.5);
    D time(0.0);
    time.derivative = {0.0, 2.0};
    const D found = noisy.deviation(time);
    BOOST_TEST(found.value == 0.0);
    BOOST_TEST(found.derivative[0] == 0.0);  // sqrt alone says 0/0
    BOOST_TEST(found.derivative[1] == infinite);
    BOOST_TEST(std::isnan(sqrt(time).derivative[0]));
    time.value = 1e-30;
    BOOST_TEST(noisy.deviation(time).derivative[0] == 0.0);
    BOOST_TEST(relative(noisy.deviation(time).derivative[1], 0.5 * 0.5 * 2.0 / 1e-15) <= 8.0 * eps);
  }
}

// 1 - e^{-2 gamma t} is 2 gamma t to a relative gamma t: nothing is left of it but sigma sqrt(t). Below the
// least normal number 1/gamma overflows.
BOOST_AUTO_TEST_CASE(friction_that_is_hardly_there_is_none) {
  const double walk = bath::of_sigma(0.0, 0.05).deviation(0.01);
  for (const double friction : {1e-20, 1e-300, 1e-310, 5e-324}) {
    BOOST_TEST(relative(bath::of_sigma(friction, 0.05).deviation(0.01), walk) <= 4.0 * eps);
  }
  BOOST_TEST(relative(bath::of_sigma(1e-3, 0.05).deviation(0.01), walk) > 4.0 * eps);
}
