// SPDX-License-Identifier: BSL-1.0
// Integers in lanes do what 64-bit integers do, Philox is that of its authors, the elementary functions of
// the noise are exact to a few roundings, and bits choose points of the plane as Box and Muller ask.
#include <boost/test/unit_test.hpp>

#include <Random123/philox.h>

#include <limits>
#include <numbers>

#include "../support/draws.hpp"
#include "nysalt/noises/box_muller.hpp"
#include "nysalt/noises/philox.hpp"
#include "nysalt/noises/words.hpp"

using namespace nysalt;
using detail::words;
using nysalt::test::draws;

namespace {

/// Is f over words f over integers, in every lane?
bool lane_by_lane(const auto& f, const auto& of_integers) {
  draws random;
  words a;
  words b;
  for (int lane = 0; lane < words::lanes; ++lane) a.set(lane, random.bits());
  for (int lane = 0; lane < words::lanes; ++lane) b.set(lane, random.bits());
  const words result = f(a, b);
  bool same = true;
  for (int lane = 0; lane < words::lanes; ++lane)
    same = same && result[lane] == of_integers(a[lane], b[lane]);
  return same;
}
bool lane_by_lane(const auto& f) { return lane_by_lane(f, f); }

}  // namespace

BOOST_AUTO_TEST_CASE(operations_act_lane_by_lane) {
  BOOST_TEST(lane_by_lane([](const auto& a, const auto& b) { return a + b; }));  // half of the sums wrap
  BOOST_TEST(lane_by_lane([](const auto& a, const auto& b) { return a & b; }));
  BOOST_TEST(lane_by_lane([](const auto& a, const auto& b) { return a | b; }));
  BOOST_TEST(lane_by_lane([](const auto& a, const auto& b) { return a ^ b; }));
  BOOST_TEST(lane_by_lane([](const auto& a, const auto&) { return a << 13; }));
  BOOST_TEST(lane_by_lane([](const auto& a, const auto&) { return a >> 52; }));
  BOOST_TEST(!lane_by_lane([](const words& a, const words& b) { return a + b; },
                           [](std::uint64_t a, std::uint64_t b) { return a | b; }));
}

BOOST_AUTO_TEST_CASE(only_lower_halves_are_multiplied) {
  BOOST_TEST(
      lane_by_lane([](const words& a, const words& b) { return product_of_lower_halves(a, b); },
                   [](std::uint64_t a, std::uint64_t b) { return (a & 0xffffffffU) * (b & 0xffffffffU); }));
  const words largest = 0xffffffffU;
  BOOST_TEST(product_of_lower_halves(largest, largest)[0] == 0xfffffffe00000001U);
}

BOOST_AUTO_TEST_CASE(one_number_stands_for_all_lanes_and_bits_for_doubles) {
  const words all = 0x3ff8000000000000U;
  const words bits = words::of(pack<double>(1.5));
  for (int lane = 0; lane < words::lanes; ++lane) {
    BOOST_TEST(all[lane] == 0x3ff8000000000000U);
    BOOST_TEST(all.as_doubles()[lane] == 1.5);
    BOOST_TEST(bits[lane] == all[lane]);
  }
}

BOOST_AUTO_TEST_CASE(not_zero_tells_lanes_apart) {
  words some = 0;
  some.set(1, std::uint64_t{1} << 63U);
  for (int lane = 0; lane < words::lanes; ++lane) BOOST_TEST(some.not_zero()[lane] == (lane == 1));
}

BOOST_AUTO_TEST_CASE(lanes_are_numbered) {
  const words numbers = words::lane_numbers();
  for (int lane = 0; lane < words::lanes; ++lane)
    BOOST_TEST(numbers[lane] == static_cast<std::uint64_t>(lane));
}

namespace {

using block = std::array<std::uint32_t, 4>;

/// The four words that come out of a lane.
block of_lane(const std::array<words, 2>& bits, int lane) {
  const auto upper = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32U); };
  const auto lower = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  return {upper(bits[0][lane]), lower(bits[0][lane]), upper(bits[1][lane]), lower(bits[1][lane])};
}

block ours(const block& counter, std::uint64_t key) {
  return of_lane(detail::philox({counter[0], counter[1], counter[2], counter[3]}, key), 0);
}

template <int Rounds>
block theirs(const block& counter, std::uint64_t key) {
  const auto result = r123::Philox4x32_R<Rounds>()(
      {{counter[0], counter[1], counter[2], counter[3]}},
      {{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32U)}});
  return {result[0], result[1], result[2], result[3]};
}

}  // namespace

BOOST_AUTO_TEST_CASE(philox_has_known_answers) {  // the file kat_vectors of Random123, philox4x32 10
  constexpr std::uint32_t ones = 0xffffffffU;
  BOOST_TEST((ours({0, 0, 0, 0}, 0) == block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  BOOST_TEST((ours({ones, ones, ones, ones}, 0xffffffffffffffffU) ==
              block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  BOOST_TEST((ours({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0x299f31d0a4093822U) ==
              block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

BOOST_AUTO_TEST_CASE(every_lane_is_a_generator_and_upper_halves_do_not_count) {
  draws random;
  for (int n = 0; n < 100; ++n) {
    std::array<words, 4> counter;
    for (words& word : counter) {
      for (int lane = 0; lane < words::lanes; ++lane) word.set(lane, random.bits());
    }
    const std::uint64_t key = random.bits();
    const auto bits = detail::philox(counter, key);
    for (int lane = 0; lane < words::lanes; ++lane) {
      block lower;
      for (std::size_t i = 0; i < 4; ++i) lower[i] = static_cast<std::uint32_t>(counter[i][lane]);
      BOOST_TEST((of_lane(bits, lane) == theirs<10>(lower, key)));
      BOOST_TEST((of_lane(bits, lane) != theirs<9>(lower, key)));
    }
  }
}

namespace {

static_assert(std::numeric_limits<long double>::digits > 60, "the judge must know more than the judged");

constexpr double unit = 0x1p-53;  // what one rounding may do

/// Largest relative error over arguments, in units: f of a pack against the judge.
double worst(const std::vector<double>& arguments, const auto& f, const auto& judge) {
  double result = 0.0;
  for (const double x : arguments) {
    const long double right = judge(static_cast<long double>(x));
    const auto off = static_cast<double>(std::abs(f(pack<double>(x))[0] / right - 1.0L));
    result = std::max(result, off / unit);
  }
  return result;
}

/// Numbers of (0, 1) of all sizes: uniform, near 0 and near 1, where log is small.
std::vector<double> unit_interval() {
  draws random;
  std::vector<double> result = {0x1p-53, 1.0 - 0x1p-53, std::sqrt(0.5)};
  for (int n = 0; n < 20'000; ++n) {
    const double u = (static_cast<double>(random.bits() >> 12U) + 0.5) * 0x1p-52;
    result.push_back(u);
    result.push_back(std::ldexp(u, -(n % 52)));
    result.push_back(1.0 - std::ldexp(u, -(n % 52) - 1));
    result.push_back(0.7 + 0.01 * u);  // about sqrt(1/2), where two terms cancel most
  }
  return result;
}

/// Quarter turns from -1/2 to 1/2, of all sizes.
std::vector<double> quarter_turns() {
  draws random;
  std::vector<double> result = {-0.5 + 0x1p-52, -0x1p-52, 0x1p-52, 0.5 - 0x1p-52};
  for (int n = 0; n < 20'000; ++n) {
    const double t = static_cast<double>(random.bits() >> 12U) * 0x1p-52 - 0.5;
    result.push_back(t);
    result.push_back(std::ldexp(t, -(n % 51)));
  }
  return result;
}

std::array<double, 2> pair_of(std::uint64_t first, std::uint64_t second) {
  const auto pair = detail::normal_pair(detail::squared_distance(first), second);
  return {pair[0][0], pair[1][0]};
}

}  // namespace

// k log 2 and 2 artanh s are rounded 1 and 5 times (s thrice) and approximated to 2 units; at worst their sum
// is half of the larger one, which doubles its part of the error.
BOOST_AUTO_TEST_CASE(the_logarithm_is_exact_to_eight_roundings) {
  const auto judge = [](long double x) { return -2.0L * std::log(x); };
  BOOST_TEST(worst(
                 unit_interval(), [](const auto& x) { return detail::minus_two_log(x); }, judge) <= 8.0);
  const auto sloppy = [](const auto& x) { return detail::minus_two_log(x) * (1.0 + 16.0 * unit); };
  BOOST_TEST(worst(unit_interval(), sloppy, judge) > 8.0);
}

// A polynomial whose terms fall quickly is rounded twice, its argument once, t * once, and approximated to 1
// or 2 units.
BOOST_AUTO_TEST_CASE(sine_and_cosine_are_exact_to_four_roundings) {
  constexpr long double quarter_turn = std::numbers::pi_v<long double> / 2.0L;
  const auto sine = [](const auto& t) { return detail::sine_and_cosine_of_quarter_turns(t).sine; };
  const auto cosine = [](const auto& t) { return detail::sine_and_cosine_of_quarter_turns(t).cosine; };
  const auto right_sine = [](long double t) { return std::sin(quarter_turn * t); };
  const auto right_cosine = [](long double t) { return std::cos(quarter_turn * t); };
  BOOST_TEST(worst(quarter_turns(), sine, right_sine) <= 4.0);
  BOOST_TEST(worst(quarter_turns(), cosine, right_cosine) <= 4.0);
  const auto longer = [&](const auto& t) { return sine(t * (1.0 + 16.0 * unit)); };
  BOOST_TEST(worst(quarter_turns(), longer, right_sine) > 4.0);
}

BOOST_AUTO_TEST_CASE(distances_go_from_just_above_zero_to_their_end) {
  const double longest = detail::squared_distance(0)[0];
  const double shortest = detail::squared_distance(0xffffffffffffffffU)[0];
  BOOST_TEST(std::abs(longest / (106.0 * std::numbers::ln2) - 1.0) <= 8.0 * unit);  // u = 2^-53
  BOOST_TEST(std::abs(shortest / 0x1p-52 - 1.0) <= 8.0 * unit);                     // u = 1 - 2^-53
  BOOST_TEST(detail::squared_distance(0xfffU)[0] == longest);                       // 12 bits are left over
  BOOST_TEST(detail::squared_distance(0x1000U)[0] < longest);
}

BOOST_AUTO_TEST_CASE(the_lowest_bits_turn_and_reflect) {
  draws random;
  for (int n = 0; n < 100; ++n) {
    const std::uint64_t first = random.bits();
    const std::uint64_t second = random.bits() & ~std::uint64_t{3};
    const auto [x, y] = pair_of(first, second);
    BOOST_TEST(x > std::abs(y));  // the quarter around the direction of x
    BOOST_TEST((pair_of(first, second + 1) == std::array{-x, -y}));
    BOOST_TEST((pair_of(first, second + 2) == std::array{y, x}));
    BOOST_TEST((pair_of(first, second + 3) == std::array{-y, -x}));
  }
}

BOOST_AUTO_TEST_CASE(the_upper_bits_sweep_the_quarter_evenly) {
  constexpr int parts = 1000;
  for (std::uint64_t n = 0; n < parts; ++n) {
    const double share = (static_cast<double>(n) + 0.5) / parts;
    const auto [x, y] = pair_of(1, static_cast<std::uint64_t>(share * 0x1p64));
    const double angle = std::atan2(y, x) / (std::numbers::pi / 2.0);  // in quarter turns
    BOOST_TEST(std::abs(angle - (share - 0.5)) <= 8.0 * unit);  // two numbers of 4 units each, and atan2
  }
  const auto [x, y] = pair_of(1, std::uint64_t{1} << 63U);  // the middle
  BOOST_TEST(y > 0.0);
  BOOST_TEST(y / x <= 0x1p-51);
}
