// SPDX-License-Identifier: BSL-1.0
// The noise is normal, and a function of its arguments alone.
#include <boost/test/unit_test.hpp>

#include "../support/statistics.hpp"
#include "nysalt/noises/counter_based.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::size_t count = 50'000;
constexpr auto purpose = noise_purpose::initial_state;

struct sample {
  std::vector<double> first, second;
};

/// Numbers that differ in one argument only.
sample draw(const auto& arguments) {
  sample result;
  for (std::uint64_t n = 0; n < count; ++n) {
    const auto [x, y] = arguments(n);
    result.first.push_back(x);
    result.second.push_back(y);
  }
  return result;
}
sample by_trajectory() {
  return draw([](std::uint64_t n) { return standard_normals(1, n, 0, purpose); });
}
sample by_seed() {
  return draw([](std::uint64_t n) { return standard_normals(n, 0, 0, purpose); });
}
sample by_slot() {
  return draw([](std::uint64_t n) { return standard_normals(1, 0, static_cast<std::uint32_t>(n), purpose); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(moments_are_those_of_the_normal_law) {
  for (const auto& [x, y] : {by_trajectory(), by_seed(), by_slot()}) {
    for (const auto& numbers : {x, y}) {
      BOOST_TEST(mean_off(numbers, 0.0, 1.0) <= 4.0);
      BOOST_TEST(deviation_off(numbers, 1.0) <= 4.0);
      std::vector<double> cubes;
      std::vector<double> fourths;
      for (const double z : numbers) cubes.push_back(z * z * z);
      for (const double z : numbers) fourths.push_back(z * z * z * z);
      BOOST_TEST(mean_off(cubes, 0.0, std::sqrt(15.0)) <= 4.0);    // E z^6 = 15
      BOOST_TEST(mean_off(fourths, 3.0, std::sqrt(96.0)) <= 4.0);  // E z^8 - 9 = 96
    }
    BOOST_TEST(std::abs(correlation(x, y)) * std::sqrt(static_cast<double>(count)) <= 4.0);
  }
}

BOOST_AUTO_TEST_CASE(the_law_is_normal_by_kolmogorov_and_smirnov) {
  for (const auto& [x, y] : {by_trajectory(), by_seed(), by_slot()}) {
    BOOST_TEST(kolmogorov_smirnov(x) <= 2.0);
    BOOST_TEST(kolmogorov_smirnov(y) <= 2.0);
    auto shifted = x;
    for (double& z : shifted) z += 0.05;  // moves F by 0.02, that is 4.5 in these units
    BOOST_TEST(kolmogorov_smirnov(shifted) > 2.0);
    auto wide = x;
    for (double& z : wide) z *= 1.1;
    BOOST_TEST(kolmogorov_smirnov(wide) > 2.0);
  }
}

BOOST_AUTO_TEST_CASE(neighbours_are_uncorrelated) {
  for (const auto& numbers : {by_trajectory().first, by_seed().first, by_slot().first}) {
    const std::vector<double> now(numbers.begin(), numbers.end() - 1);
    const std::vector<double> next(numbers.begin() + 1, numbers.end());
    BOOST_TEST(std::abs(correlation(now, next)) * std::sqrt(static_cast<double>(count)) <= 4.0);
    BOOST_TEST(std::abs(correlation(now, now)) * std::sqrt(static_cast<double>(count)) > 4.0);
  }
}

BOOST_AUTO_TEST_CASE(every_argument_counts_to_its_last_bit) {
  const auto one = standard_normals(1, 2, 3, purpose);
  BOOST_TEST((one == standard_normals(1, 2, 3, purpose)));
  BOOST_TEST((one != standard_normals(1 + (std::uint64_t{1} << 63U), 2, 3, purpose)));
  BOOST_TEST((one != standard_normals(1, 2 + (std::uint64_t{1} << 63U), 3, purpose)));
  BOOST_TEST((one != standard_normals(1, 2, 3U + (1U << 31U), purpose)));
  BOOST_TEST((one != standard_normals(1, 2, 3, static_cast<noise_purpose>(2))));
  BOOST_TEST((one != standard_normals(2, 1, 3, purpose)));
}
