// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 17 s at -O0, 0.5 s at -O1.
// The noise of many intervals in one is exactly that of the flow over all of them; and the same path at half
// the step, and again.
#include <boost/test/unit_test.hpp>

#include <limits>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/noises/finer_noise.hpp"
#include "nysalt/noises/recorded_path.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using numbers = vector<double, 2>;
using sample = std::vector<double>;
const counter_noise fresh(7);

std::vector<numbers> drawn(std::int64_t count, const counter_noise& source = fresh) {
  std::vector<numbers> result(static_cast<std::size_t>(count));
  for (std::int64_t n = 0; n < count; ++n) {
    source.normals(noise_place{0, n, 0}, result[static_cast<std::size_t>(n)]);
  }
  return result;
}
numbers in_one(double damping, std::span<const numbers> intervals) {
  numbers xi;
  coarse_graining(damping).over(intervals, xi);
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

/// A correlation in standard errors.
double off(const sample& a, const sample& b) {
  return std::abs(correlation(a, b)) * std::sqrt(static_cast<double>(a.size()));
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
  }
}

BOOST_AUTO_TEST_CASE(one_interval_keeps_its_bits_and_none_has_no_noise) {
  const auto noise = drawn(1);
  for (const double damping : {0.0, 0.3}) {
    BOOST_TEST((in_one(damping, noise) == noise[0]));
    BOOST_TEST((in_one(damping, {}) == numbers(0.0, 0.0)));
  }
}

BOOST_AUTO_TEST_CASE(coarse_of_coarse_is_coarse) {
  const auto noise = drawn(12);
  const std::span<const numbers> all(noise);
  for (const double damping : {0.0, 1e-9, 0.3, 5.0}) {
    const auto coarser = [&](std::size_t length, auto&& of_some) {
      std::vector<numbers> result;
      for (std::size_t n = 0; n < 12; n += length) result.push_back(of_some(damping, all.subspan(n, length)));
      return result;
    };
    // A dozen additions of numbers below 4.
    const double rounding = 12.0 * 4.0 * eps;
    for (const std::size_t length : {2U, 3U, 4U, 6U}) {
      const double coarse_damping = damping * static_cast<double>(length);
      BOOST_TEST(largest(in_one(coarse_damping, coarser(length, in_one)) - in_one(damping, all)) <= rounding);
      if (damping < 0.3) continue;
      BOOST_TEST(largest(in_one(coarse_damping, coarser(length, reversed_in_one)) - in_one(damping, all)) >
                 1e-3);
      BOOST_TEST(largest(in_one(damping, coarser(length, in_one)) - in_one(damping, all)) > 1e-3);
    }
  }
}

BOOST_AUTO_TEST_CASE(coarse_numbers_are_standard_normal_and_independent) {
  constexpr std::int64_t count = 20'000;
  constexpr std::int64_t n = 8;
  constexpr double damping = 0.3;
  const auto noise = drawn(count * n, counter_noise(seed(7)));
  const auto each = [&](double scale, std::int64_t length) {
    std::array<std::vector<double>, 2> result;
    for (std::int64_t k = 0; k + 1 < count; ++k) {
      const auto these =
          std::span(noise).subspan(static_cast<std::size_t>(k * n), static_cast<std::size_t>(length));
      const numbers xi = in_one(damping, these) * scale;
      for (std::size_t i = 0; i < 2; ++i) result[i].push_back(xi[static_cast<Eigen::Index>(i)]);
    }
    return result;
  };
  const auto follow = [](const sample& x) {
    return off(sample(x.begin(), x.end() - 1), sample(x.begin() + 1, x.end()));
  };
  const auto [x, y] = each(1.0, n);
  constexpr double rate = false_alarms / 9;  // two times four, and their correlation
  const double allowed = standard_errors(rate);
  for (const auto& z : {x, y}) {
    BOOST_TEST(mean_off(z, 0.0, 1.0) <= allowed);
    BOOST_TEST(deviation_off(z, 1.0) <= allowed);
    BOOST_TEST(kolmogorov_smirnov(z) <= kolmogorov_smirnov_limit(rate));
    BOOST_TEST(follow(z) <= allowed);
  }
  BOOST_TEST(off(x, y) <= allowed);
  BOOST_TEST(deviation_off(each(1.06, n)[0], 1.0) > allowed);  // 6 % are 12 standard errors
  BOOST_TEST(follow(each(1.0, n + 4)[0]) > allowed);           // where neighbours share 4 intervals: also 12
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
  BOOST_TEST(refuses<wrong>([&] { over(3, 6); }, {"4 to 10", "for 3 to 6", "0.1"}));
  BOOST_TEST(refuses<wrong>([&] { over(9, 11); }, {"4 to 10", "for 9 to 11", "longer"}));
  path.forget_before(100);
  BOOST_TEST(path.begin() == 10);
  path.add(noise[0]);
  BOOST_TEST((over(10, 11) == noise[0]));
}

BOOST_AUTO_TEST_CASE(what_is_no_path_is_refused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](double interval, double friction, std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { recorded_path<double, 2>(interval, friction); }, words);
  };
  BOOST_TEST(refused(0.0, 1.0, {"interval must be > 0", "got 0 and 1"}));
  BOOST_TEST(refused(-0.1, 1.0, {"interval must be > 0", "-0.1"}));
  BOOST_TEST(refused(nan, 1.0, {"interval must be > 0", "nan"}));
  BOOST_TEST(refused(0.1, -1.0, {"friction >= 0", "-1"}));
  BOOST_TEST(refused(0.1, nan, {"friction >= 0", "nan"}));
  BOOST_TEST(!refused(0.1, 0.0, {}));
}

namespace {

using triple = vector<double, 3>;

triple at(const finer_noise& noise, std::int64_t step, std::uint64_t trajectory = 0) {
  triple xi;
  noise.normals(noise_place{trajectory, step, 0}, xi);
  return xi;
}
/// The noise of a step of a path, of its parts in one; `damping` is that of a part.
triple recombined(const finer_noise& noise, double damping, std::int64_t step, std::int64_t parts) {
  const coarse_graining coarse(damping);
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

}  // namespace

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

BOOST_AUTO_TEST_CASE(eighths_are_the_whole) {
  constexpr double damping = 0.7;
  for (std::int64_t step = 0; step < 20; ++step) {
    const triple whole = at(finer_noise(7, damping, 0), step);
    const triple of_eight = recombined(finer_noise(7, damping, 3), damping / 8.0, step, 8);
    BOOST_TEST(largest(whole - of_eight) <= 3.0 * 4.0 * 16.0 * eps);
    BOOST_TEST((whole - recombined(finer_noise(8, damping, 3), damping / 8.0, step, 8)).norm() > 1e-3);
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
        BOOST_TEST(off(x[0], x[1]) <= allowed);
        BOOST_TEST(off(x[1], x[2]) <= allowed);
        for (const std::int64_t by : {1, 2, 3, 4, 8}) {
          const auto [now, later] = shifted(by);
          BOOST_TEST(off(now, later) <= allowed);
          BOOST_TEST(off(squares(now), squares(later)) <= allowed);
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
    for (std::size_t k = 0; k < n; ++k) worst = std::max(worst, off(x[n], x[k]));
  }
  const double allowed = standard_errors(false_alarms / 300);  // 24 deviations, 276 correlations
  BOOST_TEST(worst <= allowed);
  for (std::size_t k = 0; k < count; ++k) x[17][k] += 0.2 * x[3][k];  // 12 standard errors
  BOOST_TEST(off(x[17], x[3]) > allowed);
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

BOOST_AUTO_TEST_CASE(levels_share_the_path_and_nothing_else) {
  constexpr std::int64_t count = 20'000;
  sample whole, first, second, of_the_next;
  for (std::int64_t n = 0; n < count; ++n) {
    whole.push_back(at(finer_noise(seed(7), 0.7, 0), n)[0]);
    first.push_back(at(finer_noise(seed(7), 0.7, 1), 2 * n)[0]);
    second.push_back(at(finer_noise(seed(7), 0.7, 1), 2 * n + 1)[0]);
    of_the_next.push_back(at(finer_noise(seed(7), 0.7, 1), 2 * n + 2)[0]);
  }
  // With a = exp(-.35) the halves are a/sqrt(1 + a^2) and 1/sqrt(1 + a^2) of the whole; a correlation r has
  // the standard error (1 - r^2)/sqrt(n).
  const double a = std::exp(-0.35);
  const double scale = 1.0 / std::sqrt(1.0 + a * a);
  const double allowed = standard_errors(false_alarms / 3) / std::sqrt(static_cast<double>(count));
  BOOST_TEST(std::abs(correlation(whole, first) - a * scale) <= allowed * (1.0 - a * scale * a * scale));
  BOOST_TEST(std::abs(correlation(whole, second) - scale) <= allowed * (1.0 - scale * scale));
  BOOST_TEST(std::abs(correlation(whole, of_the_next)) <= allowed);
  BOOST_TEST(std::abs(correlation(whole, first) - scale) > allowed);  // the halves the other way round
}
