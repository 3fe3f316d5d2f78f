// SPDX-License-Identifier: BSL-1.0
// The noise of many intervals in one is exactly that of the flow over all of them.
#include "nysalt/noises/recorded_path.hpp"

#include <boost/test/unit_test.hpp>

#include <limits>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using numbers = vector<double, 2>;
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

double largest(const numbers& x) { return x.cwiseAbs().maxCoeff(); }

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
  const auto off = [](std::span<const double> a, std::span<const double> b) {
    const std::vector<double> x(a.begin(), a.end());
    const std::vector<double> y(b.begin(), b.end());
    return std::abs(correlation(x, y)) * std::sqrt(static_cast<double>(x.size()));
  };
  const auto follow = [&](const std::vector<double>& x) {
    return off(std::span(x).first(x.size() - 1), std::span(x).last(x.size() - 1));
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

BOOST_AUTO_TEST_CASE(lanes_are_singles_to_the_bit) {
  using T = pack<double, 8>;
  recorded_path<T, 2> together(0.1, 3.0, 40);
  std::vector<recorded_path<double, 2>> singles(8, {0.1, 3.0});
  for (std::int64_t n = 0; n < 5; ++n) {
    vector<T, 2> xi;
    fresh.normals(noise_place{40, n, 0}, xi);
    together.add(xi);
    for (int k = 0; k < 8; ++k) singles[static_cast<std::size_t>(k)].add(lane(xi, k));
  }
  vector<T, 2> all;
  together.over(1, 5, all);
  for (int k = 0; k < 8; ++k) {
    numbers one;
    singles[static_cast<std::size_t>(k)].over(1, 5, one);
    BOOST_TEST((lane(all, k) == one));
    BOOST_TEST((lane(all, (k + 1) % 8) != one));
  }
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
