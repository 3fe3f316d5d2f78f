// SPDX-License-Identifier: BSL-1.0
// Also with noise: a method as data takes the steps that the type-level method takes.
#include <boost/test/unit_test.hpp>

#include "../laws/noisy_models.hpp"
#include "../laws/run_laws.hpp"
#include "../laws/trials.hpp"
#include "../support/noises.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::int64_t steps = 100;

/// Whether runs and plain steps of both have the same bits.
template <System S, Method M>
bool steps_alike(const S& system, const M& method, double step, const phase_point<double, S::dimension>& x,
                 const auto& noise) {
  const auto by_type = make_stepper(system, method, step, noise);
  const auto by_data = make_stepper(system, tabulated(method), step, noise);
  auto plain = x;
  auto plain_as_data = x;
  by_type.step(plain, 5, 9);
  by_data.step(plain_as_data, 5, 9);
  return same_bits(plain_as_data, plain) &&
         same_bits(run_finish(by_data, x, steps, 5), run_finish(by_type, x, steps, 5));
}

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(with_fresh_noise, M, noisy_methods) {
  try_on<M, noisy_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    BOOST_TEST(steps_alike(system, method, step, x, counter_noise(7)));
  });
}

BOOST_AUTO_TEST_CASE_TEMPLATE(along_a_path, M, noisy_methods) {
  try_on<M, std::tuple<a_warm_fpu>>([](const auto& system, const auto& method, double step, const auto& x) {
    BOOST_TEST(steps_alike(system, method, step, x, noise_of_a_path(7)));
  });
}

BOOST_AUTO_TEST_CASE(looking_and_cutting_change_no_bit) {
  const counter_noise noise(7);
  for (const auto& method : {tabulated(baoab{}), tabulated(obabo{})}) {
    try_on_method<noisy_systems>(
        method, [&](const auto& system, const auto& table, double step, const auto& x) {
          const auto fixed = make_stepper(system, table, step, noise);
          const auto unobserved = run_finish(fixed, x, steps);
          BOOST_TEST(same_bits(watched_finish(fixed, x, steps, 3), unobserved));
          for (const std::int64_t first : {0, 1, 37}) {
            BOOST_TEST(same_bits(cut_finish(system, table, step, x, steps, first, noise), unobserved));
          }
          BOOST_TEST(!same_bits(run_finish(fixed, x, steps + 1), unobserved));
        });
  }
}
