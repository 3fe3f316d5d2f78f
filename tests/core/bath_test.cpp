// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 3 s at -O0, 0.1 s at -O1.
// The bath's formulas, against more digits and in their limits; and two letters O that meet between steps:
// one draw for the run, and two independent halves for who looks.
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/core.hpp"

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

using O = ornstein_uhlenbeck;
using cursor = detail::noise_cursor<counter_noise, double, 2, detail::no_room>;
using state = flow_state<double, 2>;

const counter_noise source(1);
const potential_only system_of_unit_masses;

/// c and h are such that the two halves differ.
struct meeting {
  bath heat_bath;
  O::prepared<double> end = O::prepare(0.3, 0.5, heat_bath);
  O::prepared<double> begin = O::prepare(0.7, 0.5, heat_bath);
  detail::merged_half_steps<double> seam{end, begin, heat_bath.sigma() > 0.0};
};

cursor at(std::uint64_t trajectory, std::int64_t step) {
  return {&source, trajectory, step, 2, true, {}, {}};
}
state moving(double p) { return {{{0.1, 0.2}, {p, p}}, {0.0, 0.0}}; }

const std::vector<meeting> meetings{{bath::of_sigma(0.8, 0.6)}, {bath::of_sigma(0.0, 0.6)}};

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
  // The naive formula would be found out.
  const double exact = exact_deviation(1e-10, 1.0, 1e-3);
  BOOST_TEST(relative(naive_deviation(1e-10, 1.0, 1e-3), exact) > 1e-4);
  BOOST_TEST(naive_deviation(1e-10, 1.0, 1e-8) == 0.0);
}

// 1 - e^{-2 gamma t} is 2 gamma t to a relative gamma t: nothing is left of it but sigma sqrt(t). Below the
// least normal number 1/gamma overflows.
BOOST_AUTO_TEST_CASE(
    without_friction_the_deviation_grows_as_a_random_walk_and_with_friction_a_long_time_forgets) {
  const auto heating = bath::of_sigma(0.0, 0.7);
  for (const double time : {1e-8, 0.01, 3.0}) {
    BOOST_TEST(heating.deviation(time) == std::sqrt(time) * 0.7);
    BOOST_TEST(heating.decay(time) == 1.0);
    for (const double friction : {1e-20, 1e-300, 1e-310, 5e-324}) {
      BOOST_TEST(relative(bath::of_sigma(friction, 0.7).deviation(time), 0.7 * std::sqrt(time)) <= 4.0 * eps);
    }
  }
  BOOST_TEST(relative(bath::of_sigma(1e-3, 0.7).deviation(0.01), heating.deviation(0.01)) > 4.0 * eps);
  const auto warm = bath::of_temperature(0.5, 2.0);
  BOOST_TEST(warm.decay(1e4) == 0.0);
  BOOST_TEST(relative(warm.deviation(1e4), std::sqrt(2.0)) <= 4.0 * eps);
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
  for (const auto& idle : {bath::of_sigma(0.0, 0.0), bath::of_temperature(0.0, 1.0)}) {
    BOOST_TEST(!idle.acts());
    BOOST_TEST(idle.deviation(0.3) == 0.0);
  }
  BOOST_TEST(bath::of_sigma(0.0, 0.1).acts());
  for (const auto& cold : {bath::of_sigma(0.1, 0.0), bath::of_temperature(0.1, 0.0)}) {
    BOOST_TEST(cold.acts());
    BOOST_TEST(cold.deviation(0.3) == 0.0);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  for (const double bad : {-1e-300, -1.0, infinite, -infinite, std::nan("")}) {
    const std::string said = fmt::format("got {}", bad);
    BOOST_TEST(refuses([&] { bath::of_sigma(bad, 1.0); }, {"bath", "friction", "negative", said}));
    BOOST_TEST(refuses([&] { bath::of_sigma(1.0, bad); }, {"bath", "sigma", "negative", said}));
    BOOST_TEST(refuses([&] { bath::of_temperature(bad, 1.0); }, {"bath", "friction", said}));
    BOOST_TEST(refuses([&] { bath::of_temperature(1.0, bad); }, {"bath", "temperature", said}));
  }
  // Finite numbers whose sigma is not: 2 friction temperature is above the largest double, 1.8e308.
  for (const auto& [friction, temperature] : {std::pair(1e200, 1e150), std::pair(1e308, 1.0)}) {
    BOOST_TEST(refuses(
        [f = friction, t = temperature] { bath::of_temperature(f, t); },
        {"friction and temperature", "finite product", fmt::format("{} and {}", friction, temperature)}));
  }
  BOOST_TEST(std::isfinite(bath::of_temperature(8e307, 1.0).sigma()));
}

// da/dt = -gamma a, and d(s^2)/dt = sigma^2 a^2.
BOOST_AUTO_TEST_CASE(derivatives_and_lanes_flow_through_it) {
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
    pack<double, 2> times(time.value);
    times.set(0, 0.5 * time.value);
    BOOST_TEST((noisy.decay(times)[0] == noisy.decay(0.5 * time.value) && noisy.decay(times)[1] == a.value));
    const auto deviations = noisy.deviation(times);
    BOOST_TEST((deviations[0] == noisy.deviation(0.5 * time.value) && deviations[1] == s.value));
    const D walk = bath::of_sigma(0.0, noisy.sigma()).deviation(time);
    BOOST_TEST(relative(walk.derivative[0], 0.5 * noisy.sigma() / std::sqrt(time.value)) <= 4.0 * eps);
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

// xi_1 = u xi + v zeta and xi_2 = v xi - u zeta with u^2 + v^2 = 1: independent, as xi and zeta are. Two
// products of numbers below 6 and a sum. And a_2 (a_1 p + s_1 xi_1) + s_2 xi_2 = a_2 a_1 p + s xi, to some
// ten roundings of numbers below 6.
BOOST_AUTO_TEST_CASE(what_crosses_a_seam_is_its_two_halves_which_are_independent_numbers_turned) {
  for (const auto& two : meetings) {
    const double of_end = two.begin.decay * two.end.deviation;
    const double s = std::hypot(of_end, two.begin.deviation);
    const double u = of_end / s;
    const double v = two.begin.deviation / s;
    for (std::uint64_t m = 0; m < 100; ++m) {
      vector<double, 2> xi;
      vector<double, 2> zeta;
      source.normals({m, 3, 0}, xi);
      source.halving({m, 3, 0}, zeta);
      const auto noise_of = [&](auto&& part) {  // of what is at rest before it, after a part of the seam
        auto x = moving(0.0);
        auto where = at(m, 3);
        part(where, x);
        return x.p;
      };
      const double first =
          noise_of([&](auto&... x) { two.seam.end(system_of_unit_masses, x...); })[1] / two.end.deviation;
      const double second =
          noise_of([&](auto&... x) { two.seam.begin(system_of_unit_masses, x...); })[1] / two.begin.deviation;
      const double whole = noise_of([&](auto&... x) { two.seam.cross(system_of_unit_masses, x...); })[0];
      BOOST_TEST(std::abs(first - (u * xi[1] + v * zeta[1])) <= 32.0 * eps);
      BOOST_TEST(std::abs(second - (v * xi[1] - u * zeta[1])) <= 32.0 * eps);
      BOOST_TEST(std::abs(second - (v * xi[1] + u * zeta[1])) > 1e-6);
      BOOST_TEST(std::abs(whole - s * xi[0]) <= 64.0 * eps);
      auto merged = moving(1.5);
      auto plain = merged;
      auto where = at(m, 3);
      two.seam.cross(system_of_unit_masses, where, merged);
      two.seam.end(system_of_unit_masses, where, plain);
      const double between = plain.p[0];
      two.seam.begin(system_of_unit_masses, where, plain);
      BOOST_TEST((merged.p - plain.p).cwiseAbs().maxCoeff() <= 64.0 * eps);
      BOOST_TEST(std::abs(merged.p[0] - between) > 1e-6);
      BOOST_TEST((merged.q == moving(0.0).q));
    }
  }
}

// Letters O with coefficient 0 at both ends are odd, but not NaN.
BOOST_AUTO_TEST_CASE(a_seam_without_a_duration_does_nothing) {
  const auto heat_bath = bath::of_sigma(0.8, 0.6);
  const auto none = O::prepare(0.0, 0.5, heat_bath);
  const detail::merged_half_steps<double> seam(none, none, true);
  auto x = moving(1.0);
  auto where = at(0, 3);
  seam.end(system_of_unit_masses, where, x);
  seam.begin(system_of_unit_masses, where, x);
  seam.cross(system_of_unit_masses, where, x);
  BOOST_TEST((x.p == moving(1.0).p));
}
