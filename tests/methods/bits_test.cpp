// SPDX-License-Identifier: BSL-1.0
// Looking at a run or cutting it in two does not change a bit.
#include <boost/test/unit_test.hpp>

#include "../laws/run_laws.hpp"
#include "../laws/trials.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(observed_is_unobserved_to_the_bit) {
  try_all_on<bound_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    const auto unobserved = integrate(system, method, step, x, 200).finish;
    for (const std::int64_t every : {1, 3, 64, 1000}) {
      BOOST_TEST(same_bits(observed_finish(system, method, step, x, 200, every), unobserved));
    }
  });
}

BOOST_AUTO_TEST_CASE(cut_is_uncut_to_the_bit) {
  try_all_on<bound_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    const auto uncut = integrate(system, method, step, x, 200).finish;
    for (const std::int64_t first : {0, 1, 77, 200}) {
      BOOST_TEST(same_bits(cut_finish(system, method, step, x, 200, first), uncut));
    }
  });
}

// Where letters merge, that is. (A short first letter rounds only where q comes near a power of two: hence
// runs that grow until one differs.)
BOOST_AUTO_TEST_CASE(reopened_is_not_the_same_to_the_bit) {
  try_all_on<bound_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    const auto is_same = [&](std::int64_t steps) {
      const auto unobserved = integrate(system, method, step, x, steps).finish;
      return same_bits(reopened_finish(system, method, step, x, steps), unobserved);
    };
    bool same = is_same(2'000);
    for (const std::int64_t steps : {20'000, 200'000, 2'000'000}) {
      if (same && method.letters().merges) same = is_same(steps);
    }
    BOOST_TEST(same != method.letters().merges);
  });
}
