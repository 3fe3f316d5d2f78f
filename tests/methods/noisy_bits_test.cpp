// SPDX-License-Identifier: BSL-1.0
// Also with noise: looking at a run or cutting it in two does not change a bit.
#include <boost/test/unit_test.hpp>

#include "../laws/noisy_models.hpp"
#include "../laws/run_laws.hpp"
#include "../laws/trials.hpp"
#include "nysalt/noises/counter_noise.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
constexpr std::int64_t steps = 100;
}

BOOST_AUTO_TEST_CASE_TEMPLATE(observed_and_cut_are_neither_to_the_bit, M, noisy_methods) {
  try_on<M, noisy_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    const counter_noise noise(7);
    const auto fixed = make_stepper(system, method, step, noise);
    const auto unobserved = run_finish(fixed, x, steps);
    for (const std::int64_t every : {1, 3, 64, 1000}) {
      BOOST_TEST(same_bits(observed_finish(system, method, step, x, steps, every, noise), unobserved));
      BOOST_TEST(same_bits(watched_finish(fixed, x, steps, every), unobserved));
    }
    for (const std::int64_t first : {0, 1, 37, 100}) {
      BOOST_TEST(same_bits(cut_finish(system, method, step, x, steps, first, noise), unobserved));
    }
    BOOST_TEST(!same_bits(run_finish(fixed, x, steps, 1), unobserved));  // another trajectory, another seed
    BOOST_TEST(
        !same_bits(run_finish(make_stepper(system, method, step, counter_noise(8)), x, steps), unobserved));
  });
}

// What observing must not do: a run that is closed and opened anew takes other noise, or another route.
BOOST_AUTO_TEST_CASE(reopened_is_not_the_same) {
  try_on<obabo, noisy_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    const auto fixed = make_stepper(system, method, step, counter_noise(7));
    auto y = x;
    for (std::int64_t n = 0; n < steps; ++n) {
      auto run = fixed.open(y);
      fixed.advance(run, 1);
      y = fixed.synchronous(run);
    }
    BOOST_TEST(!same_bits(y, run_finish(fixed, x, steps)));
  });
}
