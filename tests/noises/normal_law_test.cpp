// SPDX-License-Identifier: BSL-1.0
// The noise has the normal law, out to its tails, and neighbours in every field of the counter know nothing
// of each other.
#include <boost/test/unit_test.hpp>

#include "../support/statistics.hpp"
#include "nysalt/noises/counter_based.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::size_t count = 100'000;
constexpr auto purpose = noise_purpose::initial_state;

struct sample {
  std::vector<double> x, y;
};

/// The pairs at where(0), where(1), ...; `where` gives seed and counter.
sample draw(const auto& where, std::size_t pairs = count) {
  sample result;
  for (std::size_t n = 0; n < pairs; ++n) {
    const auto [seed, at] = where(n);
    std::array<double, 2> xy;
    standard_normals<double>(seed, at, xy);
    result.x.push_back(xy[0]);
    result.y.push_back(xy[1]);
  }
  return result;
}

struct place {
  std::uint64_t seed;
  noise_counter at;
};

/// Pairs that differ in one thing only.
const std::vector<sample>& samples() {
  static const std::vector<sample> all = {draw([](std::uint64_t n) {
                                            return place{1, {n, 0, 0, purpose}};
                                          }),
                                          draw([](std::uint64_t n) {
                                            return place{1, {0, static_cast<std::int64_t>(n), 0, purpose}};
                                          }),
                                          draw([](std::uint64_t n) {
                                            return place{1, {0, 0, n, purpose}};
                                          }),
                                          draw([](std::uint64_t n) {
                                            return place{n, {0, 0, 0, purpose}};
                                          })};
  return all;
}

/// A correlation in standard errors, 1/sqrt(n) for independent numbers.
double off(const std::vector<double>& a, const std::vector<double>& b) {
  return std::abs(correlation(a, b)) * std::sqrt(static_cast<double>(a.size()));
}

std::vector<double> power(std::vector<double> x, int k) {
  for (double& value : x) {
    const double factor = value;
    for (int i = 1; i < k; ++i) value *= factor;
  }
  return x;
}

/// How far the share of |z| > end is from the law's, in standard errors, binomial.
double tail_off(const std::vector<double>& x, double end) {
  const double p = std::erfc(end / std::sqrt(2.0));
  double beyond = 0.0;
  for (const double z : x) beyond += std::abs(z) > end ? 1.0 : 0.0;
  const auto n = static_cast<double>(x.size());
  return std::abs(beyond - n * p) / std::sqrt(n * p * (1.0 - p));
}

}  // namespace

BOOST_AUTO_TEST_CASE(moments_are_those_of_the_normal_law) {
  for (const auto& [x, y] : samples()) {
    for (const auto& z : {x, y}) {
      BOOST_TEST(mean_off(z, 0.0, 1.0) <= 4.0);
      BOOST_TEST(deviation_off(z, 1.0) <= 4.0);
      BOOST_TEST(mean_off(power(z, 3), 0.0, std::sqrt(15.0)) <= 4.0);      // E z^6 = 15
      BOOST_TEST(mean_off(power(z, 4), 3.0, std::sqrt(96.0)) <= 4.0);      // E z^8 - 3^2 = 105 - 9
      BOOST_TEST(mean_off(power(z, 6), 15.0, std::sqrt(10170.0)) <= 4.0);  // E z^12 - 15^2 = 10395 - 225
    }
  }
  auto wide = samples().front().x;
  for (double& z : wide) z *= 1.02;  // moves moment k by 2 k %: 9, 8 and 6 standard errors
  BOOST_TEST(deviation_off(wide, 1.0) > 4.0);
  BOOST_TEST(mean_off(power(wide, 4), 3.0, std::sqrt(96.0)) > 4.0);
  BOOST_TEST(mean_off(power(wide, 6), 15.0, std::sqrt(10170.0)) > 4.0);
  auto skew = samples().front().x;
  for (double& z : skew) z += 0.02;  // E z^3 = .06: 5 standard errors
  BOOST_TEST(mean_off(skew, 0.0, 1.0) > 4.0);
  BOOST_TEST(mean_off(power(skew, 3), 0.0, std::sqrt(15.0)) > 4.0);
}

BOOST_AUTO_TEST_CASE(the_law_is_normal_by_kolmogorov_and_smirnov) {
  for (const auto& [x, y] : samples()) {
    BOOST_TEST(kolmogorov_smirnov(x) <= 2.0);
    BOOST_TEST(kolmogorov_smirnov(y) <= 2.0);
  }
  auto shifted = samples().front().x;
  for (double& z : shifted) z += 0.03;  // moves F by 0.012, that is 3.8 in these units
  BOOST_TEST(kolmogorov_smirnov(shifted) > 2.0);
}

BOOST_AUTO_TEST_CASE(the_tails_are_there) {
  std::vector<double> many(400'000);
  standard_normals<double>(1, {0, 0, 0, purpose}, many);
  for (const double end : {2.0, 3.0, 4.0}) BOOST_TEST(tail_off(many, end) <= 4.0);  // 25 are beyond 4
  for (double& z : many) z = std::clamp(z, -4.0, 4.0);
  BOOST_TEST(tail_off(many, 4.0) > 4.0);
  BOOST_TEST(kolmogorov_smirnov(many) <= 2.0);  // which does not see that
}

BOOST_AUTO_TEST_CASE(the_two_of_a_pair_are_independent) {
  for (const auto& [x, y] : samples()) {
    BOOST_TEST(off(x, y) <= 4.0);
    BOOST_TEST(off(power(x, 2), power(y, 2)) <= 4.0);
    BOOST_TEST(off(power(x, 2), y) <= 4.0);
    BOOST_TEST(off(x, power(y, 2)) <= 4.0);
  }
  auto [x, y] = samples().front();  // uncorrelated, yet of the same size
  for (std::size_t i = 0; i < count; ++i) y[i] = i % 2 == 0 ? x[i] : -x[i];
  BOOST_TEST(off(x, y) <= 4.0);
  BOOST_TEST(off(power(x, 2), power(y, 2)) > 4.0);
}

BOOST_AUTO_TEST_CASE(neighbours_are_uncorrelated) {
  const auto now = [](const std::vector<double>& x) { return std::vector(x.begin(), x.end() - 1); };
  const auto next = [](const std::vector<double>& x) { return std::vector(x.begin() + 1, x.end()); };
  for (const auto& [x, y] : samples()) {
    BOOST_TEST(off(now(x), next(x)) <= 4.0);
    BOOST_TEST(off(now(x), next(y)) <= 4.0);
    BOOST_TEST(off(now(y), next(x)) <= 4.0);
    BOOST_TEST(off(power(now(x), 2), power(next(x), 2)) <= 4.0);
  }
  auto drifting = samples().front().x;
  for (std::size_t i = 1; i < count; ++i) drifting[i] += 0.02 * drifting[i - 1];  // 6 standard errors
  BOOST_TEST(off(now(drifting), next(drifting)) > 4.0);
}

// 1000 numbers and those whose counter or seed differs in one bit; they run over steps where trajectories are
// tried, and over trajectories elsewhere.
BOOST_AUTO_TEST_CASE(counters_that_differ_in_one_bit_are_uncorrelated) {
  const auto over_trajectories = [](const place& p) {
    return draw(
        [&](std::uint64_t n) {
          return place{p.seed, {n, p.at.step, p.at.slot, p.at.purpose}};
        },
        1000);
  };
  const auto over_steps = [](std::uint64_t trajectory) {
    return draw(
        [&](std::uint64_t n) {
          return place{1, {trajectory, static_cast<std::int64_t>(n), 0, purpose}};
        },
        1000);
  };
  const auto in_trajectories = over_trajectories({1, {0, 0, 0, purpose}}).x;
  const auto in_steps = over_steps(0).x;
  double worst = 0.0;
  const auto compare = [&](const place& p) {
    worst = std::max(worst, off(in_trajectories, over_trajectories(p).x));
  };
  for (int bit = 0; bit < 48; ++bit) {
    worst = std::max(worst, off(in_steps, over_steps(std::uint64_t{1} << bit).x));
    compare({1, {0, std::int64_t{1} << bit, 0, purpose}});
  }
  for (int bit = 0; bit < 24; ++bit) compare({1, {0, 0, std::uint64_t{1} << bit, purpose}});
  for (unsigned bit = 1; bit < 8; ++bit)
    compare({1, {0, 0, 0, static_cast<noise_purpose>(1U ^ (1U << bit))}});
  for (int bit = 0; bit < 64; ++bit) compare({1 ^ (std::uint64_t{1} << bit), {0, 0, 0, purpose}});
  BOOST_TEST(worst <= 4.0);  // 191 of them: passed with a probability of .988
  compare({1, {0, 0, 0, purpose}});
  BOOST_TEST(worst > 4.0);  // themselves
}

// A seed that is added to the counter passes every test above, and gives ensembles that share trajectories.
BOOST_AUTO_TEST_CASE(another_seed_is_no_shift_of_the_counter) {
  const auto of_seed = [](std::uint64_t seed, std::uint64_t first) {
    return draw([&](std::uint64_t n) { return place{seed, {first + n, 0, 0, purpose}}; }, 10'000).x;
  };
  const auto of_shift = [](std::uint64_t seed, std::uint64_t first) {
    return draw([&](std::uint64_t n) { return place{1, {seed + first + n, 0, 0, purpose}}; }, 10'000).x;
  };
  for (std::uint64_t first = 0; first < 3; ++first) {
    BOOST_TEST(off(of_seed(1, first), of_seed(2, 0)) <= 4.0);
    BOOST_TEST(off(of_seed(1, 0), of_seed(2, first)) <= 4.0);
  }
  BOOST_TEST(off(of_shift(1, 1), of_shift(2, 0)) > 4.0);
}
