// SPDX-License-Identifier: BSL-1.0
// The same path at half the step, and again.
#include "nysalt/noises/finer_noise.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/noises/recorded_path.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using numbers = vector<double, 3>;
using sample = std::vector<double>;

numbers at(const finer_noise& noise, std::int64_t step, std::uint64_t trajectory = 0) {
  numbers xi;
  noise.normals(noise_place{trajectory, step, 0}, xi);
  return xi;
}
/// The noise of a step of a path, of its parts in one; `damping` is that of a part.
numbers recombined(const finer_noise& noise, double damping, std::int64_t step, std::int64_t parts) {
  const coarse_graining coarse(damping);
  numbers sum;
  coarse.first(sum);
  for (std::int64_t k = 0; k < parts; ++k) coarse.next(sum, at(noise, step * parts + k));
  coarse.last(sum, parts);
  return sum;
}

double off(const sample& a, const sample& b) {
  return std::abs(correlation(a, b)) * std::sqrt(static_cast<double>(a.size()));
}
sample squares(sample x) {
  for (double& z : x) z *= z;
  return x;
}

}  // namespace

BOOST_AUTO_TEST_CASE(without_halving_it_is_the_fresh_noise) {
  const finer_noise same(7, 0.3, 0);
  for (const std::int64_t step : {0, 1, 17}) {
    numbers xi;
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
        const auto distance = [&](const numbers& x) { return (at(whole, step) - x).cwiseAbs().maxCoeff(); };
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
    const numbers whole = at(finer_noise(7, damping, 0), step);
    const numbers of_eight = recombined(finer_noise(7, damping, 3), damping / 8.0, step, 8);
    BOOST_TEST((whole - of_eight).cwiseAbs().maxCoeff() <= 3.0 * 4.0 * 16.0 * eps);
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
        const numbers xi = at(fine, n);
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
  const auto halving = [&](std::int64_t step) -> numbers {  // (xi_1 - xi_2)/sqrt 2 without friction
    return (at(halves, 2 * step) - at(halves, 2 * step + 1)) / std::sqrt(2.0);
  };
  for (int letter = 0; letter < 4; ++letter) {
    numbers xi;
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

BOOST_AUTO_TEST_CASE(lanes_are_singles_to_the_bit) {
  using T = pack<double, 8>;
  const finer_noise fine(7, 0.7, 3);
  vector<T, 3> all;
  fine.normals(noise_place{40, 13, 0}, all);
  for (int k = 0; k < 8; ++k) {
    BOOST_TEST((lane(all, k) == at(fine, 13, 40 + static_cast<std::uint64_t>(k))));
    BOOST_TEST((lane(all, k) != at(fine, 13, 41 + static_cast<std::uint64_t>(k))));
  }
}
