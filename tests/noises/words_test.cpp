// SPDX-License-Identifier: BSL-1.0
// Integers in lanes do what 64-bit integers do.
#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
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
