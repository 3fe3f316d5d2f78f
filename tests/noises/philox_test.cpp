// SPDX-License-Identifier: BSL-1.0
// Philox is that of its authors.
#include <boost/test/unit_test.hpp>

#include <Random123/philox.h>

#include "../support/draws.hpp"
#include "nysalt/noises/philox.hpp"

using namespace nysalt;
using detail::words;
using nysalt::test::draws;

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

BOOST_AUTO_TEST_CASE(known_answers) {  // the file kat_vectors of Random123, philox4x32 10
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
