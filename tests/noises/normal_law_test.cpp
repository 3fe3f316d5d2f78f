// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 7 s at -O0, 0.3 s at -O1.
// The noise has the normal law, out to its tails, and neighbours in every field of the counter know nothing
// of each other.
#include <boost/test/unit_test.hpp>

#include "../support/seeds.hpp"
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

struct place {
  std::uint64_t seed;
  noise_counter at;
};
place at(std::uint64_t seed, std::uint64_t trajectory, std::uint64_t step = 0, std::uint64_t slot = 0,
         noise_purpose use = purpose) {
  return {seed, {trajectory, static_cast<std::int64_t>(step), slot, use}};
}

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

/// Pairs that differ in one thing only.
const std::vector<sample>& samples() {
  static const std::vector<sample> all = {draw([](std::uint64_t n) { return at(seed(1), n); }),
                                          draw([](std::uint64_t n) { return at(seed(1), 0, n); }),
                                          draw([](std::uint64_t n) { return at(seed(1), 0, 0, n); }),
                                          draw([](std::uint64_t n) { return at(seed(n), 0); })};
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

/// Whether the number of |z| > end is one that the binomial distribution exceeds, or falls below, with that
/// probability.
bool tail_is_off(const std::vector<double>& x, double end, double probability) {
  const double p = std::erfc(end / std::sqrt(2.0));
  const auto n = static_cast<int>(x.size());
  const auto beyond = static_cast<int>(std::ranges::count_if(x, [&](double z) { return std::abs(z) > end; }));
  return beyond > most_of(n, p, probability) || n - beyond > most_of(n, 1.0 - p, probability);
}

}  // namespace

BOOST_AUTO_TEST_CASE(moments_are_those_of_the_normal_law) {
  const double allowed = standard_errors(false_alarms / 40);  // 8 samples, 5 moments
  for (const auto& [x, y] : samples()) {
    for (const auto& z : {x, y}) {
      BOOST_TEST(mean_off(z, 0.0, 1.0) <= allowed);
      BOOST_TEST(deviation_off(z, 1.0) <= allowed);
      BOOST_TEST(mean_off(power(z, 3), 0.0, std::sqrt(15.0)) <= allowed);  // E z^6 = 15
      BOOST_TEST(mean_off(power(z, 4), 3.0, std::sqrt(96.0)) <= allowed);  // E z^8 - 3^2 = 105 - 9
      // E z^12 - 15^2 = 10395 - 225; its mean has the skewness 33/sqrt(count) = .1, the rate is three times
      // that.
      BOOST_TEST(mean_off(power(z, 6), 15.0, std::sqrt(10170.0)) <= allowed);
    }
  }
  auto wide = samples().front().x;
  for (double& z : wide) z *= 1.04;  // moves moment k by 4 k % and more: 18, 15 and 12 standard errors
  BOOST_TEST(deviation_off(wide, 1.0) > allowed);
  BOOST_TEST(mean_off(power(wide, 4), 3.0, std::sqrt(96.0)) > allowed);
  BOOST_TEST(mean_off(power(wide, 6), 15.0, std::sqrt(10170.0)) > allowed);
  auto skew = samples().front().x;
  for (double& z : skew) z += 0.04;  // E z^3 = .12: 10 standard errors
  BOOST_TEST(mean_off(skew, 0.0, 1.0) > allowed);
  BOOST_TEST(mean_off(power(skew, 3), 0.0, std::sqrt(15.0)) > allowed);
}

BOOST_AUTO_TEST_CASE(the_law_is_normal_by_kolmogorov_and_smirnov) {
  const double allowed = kolmogorov_smirnov_limit(false_alarms / 8);
  for (const auto& [x, y] : samples()) {
    BOOST_TEST(kolmogorov_smirnov(x) <= allowed);
    BOOST_TEST(kolmogorov_smirnov(y) <= allowed);
  }
  auto shifted = samples().front().x;
  for (double& z : shifted) z += 0.06;  // moves F by 0.024, that is 7.6 in these units
  BOOST_TEST(kolmogorov_smirnov(shifted) > allowed);
}

BOOST_AUTO_TEST_CASE(the_tails_are_there) {
  std::vector<double> many(400'000);
  standard_normals<double>(seed(1), {0, 0, 0, purpose}, many);
  constexpr double each = false_alarms / 7;  // two sides of three tails, and a distribution
  for (const double end : {2.0, 3.0, 4.0}) BOOST_TEST(!tail_is_off(many, end, each));  // 25 are beyond 4
  for (double& z : many) z = std::clamp(z, -4.0, 4.0);
  BOOST_TEST(tail_is_off(many, 4.0, each));
  BOOST_TEST(kolmogorov_smirnov(many) <= kolmogorov_smirnov_limit(each));  // which does not see that
}

BOOST_AUTO_TEST_CASE(the_two_of_a_pair_are_independent) {
  const double allowed = standard_errors(false_alarms / 17);  // 4 samples, 4 correlations, and one below
  for (const auto& [x, y] : samples()) {
    BOOST_TEST(off(x, y) <= allowed);
    BOOST_TEST(off(power(x, 2), power(y, 2)) <= allowed);
    BOOST_TEST(off(power(x, 2), y) <= allowed);
    BOOST_TEST(off(x, power(y, 2)) <= allowed);
  }
  auto [x, y] = samples().front();  // uncorrelated, yet of the same size
  for (std::size_t i = 0; i < count; ++i) y[i] = i % 2 == 0 ? x[i] : -x[i];
  BOOST_TEST(off(x, y) <= 1.2 * allowed);  // x^2 has the kurtosis that makes it sqrt(3) times as wide
  BOOST_TEST(off(power(x, 2), power(y, 2)) > allowed);
}

BOOST_AUTO_TEST_CASE(neighbours_are_uncorrelated) {
  const auto now = [](const std::vector<double>& x) { return std::vector(x.begin(), x.end() - 1); };
  const auto next = [](const std::vector<double>& x) { return std::vector(x.begin() + 1, x.end()); };
  const double allowed = standard_errors(false_alarms / 16);  // 4 samples, 4 correlations
  for (const auto& [x, y] : samples()) {
    BOOST_TEST(off(now(x), next(x)) <= allowed);
    BOOST_TEST(off(now(x), next(y)) <= allowed);
    BOOST_TEST(off(now(y), next(x)) <= allowed);
    BOOST_TEST(off(power(now(x), 2), power(next(x), 2)) <= allowed);
  }
  auto drifting = samples().front().x;
  for (std::size_t i = 1; i < count; ++i) drifting[i] += 0.04 * drifting[i - 1];  // 12 standard errors
  BOOST_TEST(off(now(drifting), next(drifting)) > allowed);
}

// 1000 numbers and those whose counter or seed differs in one bit; they run over steps where trajectories are
// tried, and over trajectories elsewhere.
BOOST_AUTO_TEST_CASE(counters_that_differ_in_one_bit_are_uncorrelated) {
  const auto over_trajectories = [](const place& p) {
    const auto step = static_cast<std::uint64_t>(p.at.step);
    return draw([&](std::uint64_t n) { return at(p.seed, n, step, p.at.slot, p.at.purpose); }, 1000).x;
  };
  const auto over_steps = [](std::uint64_t trajectory) {
    return draw([&](std::uint64_t n) { return at(seed(1), trajectory, n); }, 1000).x;
  };
  const auto in_trajectories = over_trajectories(at(seed(1), 0));
  const auto in_steps = over_steps(0);
  double worst = 0.0;
  const auto compare = [&](const place& p) {
    worst = std::max(worst, off(in_trajectories, over_trajectories(p)));
  };
  const auto flipped = [](int bit) { return std::uint64_t{1} << bit; };
  for (int bit = 0; bit < 48; ++bit) {
    worst = std::max(worst, off(in_steps, over_steps(flipped(bit))));
    compare(at(seed(1), 0, flipped(bit)));
  }
  for (int bit = 0; bit < 24; ++bit) compare(at(seed(1), 0, 0, flipped(bit)));
  for (int bit = 1; bit < 8; ++bit) {
    compare(at(seed(1), 0, 0, 0, static_cast<noise_purpose>(1U ^ flipped(bit))));
  }
  for (int bit = 0; bit < 64; ++bit) compare(at(seed(1) ^ flipped(bit), 0));
  const double allowed = standard_errors(false_alarms / 191);
  BOOST_TEST(worst <= allowed);
  compare(at(seed(1), 0));
  BOOST_TEST(worst > allowed);  // themselves
}
