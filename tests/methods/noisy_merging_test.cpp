// SPDX-License-Identifier: BSL-1.0
// Also with noise: a run, whose letters are merged, is where repeated plain steps are, to rounding.
#include <boost/test/unit_test.hpp>

#include "../laws/noisy_models.hpp"
#include "../laws/run_laws.hpp"
#include "../laws/trials.hpp"
#include "../support/noises.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(merged_is_unmerged_to_rounding, M, noisy_methods) {
  try_on<M, noisy_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    BOOST_TEST(merging_broken(system, method, step, x, 20, fresh_noise(7)) <= 1.0);
    BOOST_TEST(merging_broken(system, tabulated(method), step, x, 20, noise_of_a_path(7)) <= 1.0);
  });
}

// Plain steps that see the noise of the step before, or of another trajectory.
BOOST_AUTO_TEST_CASE_TEMPLATE(with_the_noise_of_another_place_it_is_elsewhere, M, noisy_methods) {
  try_on<M, noisy_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    const auto fixed = make_stepper(system, method, step, fresh_noise(7));
    const auto plain = [&](std::uint64_t trajectory, std::int64_t late) {
      auto y = x;
      for (std::int64_t n = 0; n < 20; ++n) fixed.step(y, trajectory, n + late);
      return y;
    };
    auto run = fixed.open(x);
    fixed.advance(run, 20);
    const auto merged = fixed.synchronous(run);
    BOOST_TEST(distance(merged, plain(0, 0)) < 1e-9);
    BOOST_TEST(distance(merged, plain(0, 1)) > 1e-6);
    BOOST_TEST(distance(merged, plain(1, 0)) > 1e-6);
  });
}
