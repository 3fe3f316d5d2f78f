// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 17 s at -O0, 0.5 s at -O1.
// The noise of many intervals in one is exactly that of the flow over all of them; the same path at half the
// step, and again; and a run along a recorded path sees that path's noise, each letter O that of its own part
// of the step.
#include "nysalt/noises/recorded_path.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using numbers = vector<double, 2>;
using sample = std::vector<double>;

std::vector<numbers> drawn(std::int64_t count) {
  std::vector<numbers> result(static_cast<std::size_t>(count));
  for (std::int64_t n = 0; n < count; ++n) {
    counter_noise(7).normals(noise_place{0, n, 0}, result[static_cast<std::size_t>(n)]);
  }
  return result;
}
numbers in_one(double damping, std::span<const numbers> intervals) {
  numbers xi;
  detail::coarse_graining(damping).over(intervals, xi);
  return xi;
}
/// With the exponent as it is printed [li_lu_tao_ye_2023, equation (3.11)], which reverses time.
numbers reversed_in_one(double damping, std::span<const numbers> intervals) {
  return in_one(damping, std::vector<numbers>(intervals.rbegin(), intervals.rend()));
}

/// The momentum after the flow O over a time.
numbers after(const numbers& p, const bath& heat_bath, double time, const numbers& xi) {
  const in_bath system(henon_heiles(), heat_bath);
  flow_state<double, 2> x{{numbers(0.0, 0.0), p}, numbers()};
  ornstein_uhlenbeck::apply(system, ornstein_uhlenbeck::prepare(1.0, time, heat_bath), xi, x);
  return x.p;
}

double largest(const auto& x) { return x.cwiseAbs().maxCoeff(); }

using triple = vector<double, 3>;

triple at(const finer_noise& noise, std::int64_t step, std::uint64_t trajectory = 0) {
  triple xi;
  noise.normals(noise_place{trajectory, step, 0}, xi);
  return xi;
}
/// The noise of a step of a path, of its parts in one; `damping` is that of a part.
triple recombined(const finer_noise& noise, double damping, std::int64_t step, std::int64_t parts) {
  const detail::coarse_graining coarse(damping);
  triple sum;
  coarse.first(sum);
  for (std::int64_t k = 0; k < parts; ++k) coarse.next(sum, at(noise, step * parts + k));
  coarse.last(sum, parts);
  return sum;
}

sample squares(sample x) {
  for (double& z : x) z *= z;
  return x;
}

using state = phase_point<double, 2>;
constexpr double tau = 0.02;   // an interval of the path
constexpr double step = 0.12;  // six of them
const bath warm = bath::of_sigma(2.0, 0.1);
const in_bath galaxy(henon_heiles(), warm);
const state start{{0.1, 0.05}, {-0.05, 0.1}};

const auto symmetric = thermostat(mclachlan2(), placement::symmetric);
const auto end = thermostat(mclachlan2(), placement::end);
const auto middle = thermostat(mclachlan2(), placement::middle);
const method thirds("thirds", word("OABOBAO"),
                    std::vector<double>{1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0}, {});

template <class T = double>
recorded_path<T, 2> path_of(std::uint64_t trajectory, std::int64_t intervals) {
  recorded_path<T, 2> path(tau, warm.friction(), trajectory);
  for (std::int64_t n = 0; n < intervals; ++n) {
    vector<T, 2> xi;
    counter_noise(7).normals(noise_place{trajectory, n, 0}, xi);
    path.add(xi);
  }
  return path;
}
template <class T>
along_path<T, 2> noise_of(const recorded_path<T, 2>& path, const method& method, double h = step) {
  return {path, detail::intervals_of_noise(method.letters(), method.coefficients()), h};
}
template <class T>
auto stepper_of(const recorded_path<T, 2>& path, const method& method, double h = step) {
  return make_stepper(galaxy, method, h, noise_of(path, method, h));
}

/// A number of steps letter by letter, with the noise of letters O taken from the path: the momentum uses one
/// interval of the path after the other.
state by_hand(const recorded_path<double, 2>& path, const method& method, int steps, state x) {
  const auto c = method.coefficients();
  const std::string_view letters = method.letters().view();
  std::int64_t interval = 0;
  for (int n = 0; n < steps; ++n) {
    for (std::size_t i = 0; i < letters.size(); ++i) {
      vector<double, 2> f;
      force<double>(galaxy, x.q, f);
      if (letters[i] == 'A') x.q += x.p * (c[i] * step);
      if (letters[i] == 'B') x.p += f * (c[i] * step);
      if (letters[i] != 'O') continue;
      for (std::int64_t left = std::llround(c[i] * step / tau); left > 0; --left, ++interval) {
        vector<double, 2> xi;
        path.over(interval, interval + 1, xi);
        x.p = x.p * warm.decay(tau) + xi * warm.deviation(tau);
      }
    }
  }
  return x;
}

void check_by_hand(const method& method) {
  const auto path = path_of(3, 60);
  const auto along = stepper_of(path, method);
  auto run = along.open(start, 3);
  along.advance(run, 10);
  const state found = along.synchronous(run);
  // Some thirty operations a step of numbers below 1, which grow little in a time of 1.2.
  BOOST_TEST(distance(found, by_hand(path, method, 10, start)) <= 10 * 30 * eps);
  BOOST_TEST(distance(found, by_hand(path_of(4, 60), method, 10, start)) > 1e-3);
}

}  // namespace

BOOST_AUTO_TEST_CASE(many_flows_are_one_with_the_noise_of_all) {
  constexpr double tau = 0.01;
  for (const double friction : {0.0, 1e-300, 1e-12, 1e-6, 0.01, 1.0, 70.0, 1e5}) {
    for (const std::int64_t n : {1, 2, 3, 190, 1000}) {
      const bath heat_bath = bath::of_sigma(friction, 0.5);
      const auto noise = drawn(n);
      const numbers start(1.0, -0.3);
      numbers p = start;
      double size = largest(start);
      for (const numbers& xi : noise) {
        p = after(p, heat_bath, tau, xi);
        size += 2.0 * heat_bath.deviation(tau) * largest(xi);
      }
      const double time = tau * static_cast<double>(n);
      // Each flow rounds its four operations, and the decays of n flows err by n roundings against that of
      // one.
      const double rounding = 4.0 * static_cast<double>(n) * eps * size;
      BOOST_TEST_CONTEXT("friction " << friction << ", " << n << " intervals") {
        BOOST_TEST(largest(after(start, heat_bath, time, in_one(friction * tau, noise)) - p) <= rounding);
        if (n > 1 && friction >= 1e-6) {
          const numbers other = after(start, heat_bath, time, reversed_in_one(friction * tau, noise));
          BOOST_TEST(largest(other - p) > 10.0 * rounding);
        }
      }
    }
    BOOST_TEST((in_one(friction * tau, drawn(1)) == drawn(1)[0]));  // of one interval, the same bits
    BOOST_TEST((in_one(friction * tau, {}) == numbers(0.0, 0.0)));
  }
}

BOOST_AUTO_TEST_CASE(a_path_gives_the_noise_of_its_intervals) {
  const auto noise = drawn(10);
  recorded_path<double, 2> path(0.1, 3.0, 5);
  for (const numbers& xi : noise) path.add(xi);
  BOOST_TEST(path.trajectory() == 5U);
  BOOST_TEST(path.interval() == 0.1);
  const auto over = [&](std::int64_t from, std::int64_t to) {
    numbers xi;
    path.over(from, to, xi);
    return xi;
  };
  const auto expected = [&](std::size_t from, std::size_t to) {
    return in_one(3.0 * 0.1, std::span(noise).subspan(from, to - from));
  };
  BOOST_TEST((over(2, 6) == expected(2, 6)));
  BOOST_TEST((over(0, 10) == expected(0, 10)));
  BOOST_TEST((over(2, 6) != expected(2, 7)));
  path.forget_before(4);
  BOOST_TEST(path.begin() == 4);
  BOOST_TEST(path.end() == 10);
  BOOST_TEST((over(4, 6) == expected(4, 6)));
  BOOST_TEST((over(9, 10) == noise[9]));
  path.forget_before(-3);  // nothing more
  BOOST_TEST(path.begin() == 4);
  BOOST_TEST(refuses([&] { over(3, 6); }, {"4 to 10", "for 3 to 6", "0.1"}));
  BOOST_TEST(refuses([&] { over(9, 11); }, {"4 to 10", "for 9 to 11", "longer"}));
  path.forget_before(100);
  BOOST_TEST(path.begin() == 10);
  path.add(noise[0]);
  BOOST_TEST((over(10, 11) == noise[0]));
  const auto refused = [](double interval, double friction, said words) {
    return refuses([&] { recorded_path<double, 2>(interval, friction); }, words);
  };
  BOOST_TEST(refused(0.0, 1.0, {"interval must be > 0", "got 0 and 1"}));
  BOOST_TEST(refused(-0.1, 1.0, {"interval must be > 0", "-0.1"}));
  BOOST_TEST(refused(not_a_number, 1.0, {"interval must be > 0", "nan"}));
  BOOST_TEST(refused(0.1, -1.0, {"friction >= 0", "-1"}));
  BOOST_TEST(refused(0.1, not_a_number, {"friction >= 0", "nan"}));
  BOOST_TEST(!refused(0.1, 0.0, {}));
}

BOOST_AUTO_TEST_CASE(without_halving_it_is_the_fresh_noise) {
  const finer_noise same(7, 0.3, 0);
  for (const std::int64_t step : {0, 1, 17}) {
    triple xi;
    counter_noise(7).normals(noise_place{5, step, 0}, xi);
    BOOST_TEST((at(same, step, 5) == xi));
    BOOST_TEST((at(same, step, 4) != xi));
  }
}

BOOST_AUTO_TEST_CASE(two_halves_are_the_whole) {
  for (const double damping : {0.0, 1e-12, 1e-3, 0.7, 20.0}) {
    for (int halvings = 1; halvings <= 5; ++halvings) {
      const finer_noise whole(7, damping, halvings - 1);
      const finer_noise halves(7, damping, halvings);
      const double of_half = std::ldexp(damping, -halvings);
      for (std::int64_t step = 0; step < 20; ++step) {
        // Six operations with numbers below 4 in each half, as many to add them, and those of the decays.
        const auto distance = [&](const triple& x) { return largest(at(whole, step) - x); };
        BOOST_TEST(distance(recombined(halves, of_half, step, 2)) <= 4.0 * 16.0 * eps);
        BOOST_TEST(distance(recombined(halves, of_half, step + 1, 2)) > 1e-3);
        if (of_half > 1e-3) BOOST_TEST(distance(recombined(halves, 2.0 * of_half, step, 2)) > 1e-9);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(halves_are_standard_normal_and_independent) {
  constexpr std::int64_t count = 40'000;
  constexpr double each = false_alarms / (9 * 15);  // 9 sources, 15 comparisons
  const double allowed = standard_errors(each);
  for (const double damping : {0.0, 0.7, 5.0}) {
    for (const int halvings : {1, 2, 3}) {
      const finer_noise fine(seed(7), damping, halvings);
      std::array<sample, 3> x;
      for (std::int64_t n = 0; n < count; ++n) {
        const triple xi = at(fine, n);
        for (std::size_t i = 0; i < 3; ++i) x[i].push_back(xi[static_cast<Eigen::Index>(i)]);
      }
      const auto shifted = [&](std::int64_t by) {
        return std::pair(sample(x[0].begin(), x[0].end() - by), sample(x[0].begin() + by, x[0].end()));
      };
      BOOST_TEST_CONTEXT("damping " << damping << ", " << halvings << " halvings") {
        BOOST_TEST(mean_off(x[0], 0.0, 1.0) <= allowed);
        BOOST_TEST(deviation_off(x[0], 1.0) <= allowed);
        BOOST_TEST(kolmogorov_smirnov(x[0]) <= kolmogorov_smirnov_limit(each));
        BOOST_TEST(correlation_off(x[0], x[1]) <= allowed);
        BOOST_TEST(correlation_off(x[1], x[2]) <= allowed);
        for (const std::int64_t by : {1, 2, 3, 4, 8}) {
          const auto [now, later] = shifted(by);
          BOOST_TEST(correlation_off(now, later) <= allowed);
          BOOST_TEST(correlation_off(squares(now), squares(later)) <= allowed);
        }
      }
    }
  }
}

// At the beginning of many trajectories, where steps of all levels have the same small numbers.
BOOST_AUTO_TEST_CASE(neighbours_of_all_levels_are_independent) {
  constexpr std::uint64_t count = 4000;
  const finer_noise fine(seed(7), 0.7, 3);
  std::array<sample, 24> x;
  for (std::uint64_t m = 0; m < count; ++m) {
    for (std::size_t n = 0; n < x.size(); ++n) {
      x[n].push_back(at(fine, static_cast<std::int64_t>(n), m)[0]);
    }
  }
  double worst = 0.0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    worst = std::max(worst, deviation_off(x[n], 1.0));
    for (std::size_t k = 0; k < n; ++k) worst = std::max(worst, correlation_off(x[n], x[k]));
  }
  const double allowed = standard_errors(false_alarms / 300);  // 24 deviations, 276 correlations
  BOOST_TEST(worst <= allowed);
  for (std::size_t k = 0; k < count; ++k) x[17][k] += 0.2 * x[3][k];  // 12 standard errors
  BOOST_TEST(correlation_off(x[17], x[3]) > allowed);
}

BOOST_AUTO_TEST_CASE(what_halves_is_no_noise_of_a_run) {
  const finer_noise halves(7, 0.0, 1);
  const auto halving = [&](std::int64_t step) -> triple {  // (xi_1 - xi_2)/sqrt 2 without friction
    return (at(halves, 2 * step) - at(halves, 2 * step + 1)) / std::sqrt(2.0);
  };
  for (int letter = 0; letter < 4; ++letter) {
    triple xi;
    counter_noise(7).normals(noise_place{0, 5, letter}, xi);
    BOOST_TEST((xi - halving(5)).norm() > 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(a_run_sees_the_noise_of_its_path) {
  check_by_hand(baoab());
  check_by_hand(obabo());
  check_by_hand(aboba());
  check_by_hand(baoab_2x());
  check_by_hand(end);
  check_by_hand(symmetric);
  check_by_hand(middle);
  check_by_hand(thirds);
}

BOOST_AUTO_TEST_CASE(a_path_of_another_length_or_trajectory_is_refused) {
  const auto refused = [](const auto& action, said words) { BOOST_TEST(refuses(action, words)); };
  const auto too_short = path_of(0, 59);  // ten steps need sixty
  const auto along = stepper_of(too_short, baoab());
  auto run = along.open(start);
  along.advance(run, 9);
  refused([&] { along.advance(run, 1); }, {"0 to 59", "for 54 to 60", "longer"});
  const auto by_halves = stepper_of(too_short, symmetric);
  auto other = by_halves.open(start);
  by_halves.advance(other, 10);  // the last half is still to come
  refused([&] { by_halves.synchronous(other); }, {"for 57 to 60"});

  const auto single = path_of(3, 60);
  const auto alone = stepper_of(single, baoab());
  for (const std::uint64_t number : {0U, 2U, 4U}) {
    auto shifted = alone.open(start, number);
    refused([&] { alone.advance(shifted, 1); }, {"trajectory 3", "not of " + std::to_string(number)});
  }
  using T = pack<double, 4>;
  const auto four = path_of<T>(3, 60);
  const auto together = stepper_of(four, baoab());
  auto shifted = together.open(start.cast<T>(), 4);  // would see its neighbours' noise
  refused([&] { together.advance(shifted, 1); }, {"trajectory 3", "not of 4"});
  auto beyond = together.open(start, 7);
  refused([&] { together.advance(beyond, 1); }, {"trajectory 3", "not of 7"});
  auto last = together.open(start, 6);
  together.advance(last, 1);
}

BOOST_AUTO_TEST_CASE(steps_are_whole_intervals_in_the_parts_that_are_needed) {
  const auto path = path_of(0, 6);
  const auto refused = [&](const auto& method, double h, said words) {
    return refuses([&] { noise_of(path, method, h); }, words);
  };
  BOOST_TEST(!refused(baoab(), 0.06, {}));
  BOOST_TEST(refused(symmetric, 0.06, {"the step 0.06 in the 2 parts", "whole intervals 0.02"}));
  BOOST_TEST(refused(baoab(), 0.05, {"the step 0.05 in the 1 parts"}));
  BOOST_TEST(refused(baoab(), 0.01, {"the step 0.01"}));
  BOOST_TEST(refused(baoab(), -0.02, {"the step -0.02"}));
  BOOST_TEST(!refused(thirds, 0.06, {}));
  BOOST_TEST(refused(thirds, 0.04, {"in the 3 parts"}));
}
