// SPDX-License-Identifier: BSL-1.0
// Runs and steps of every method cost what is declared.
#include <boost/test/unit_test.hpp>

#include "../laws/run_laws.hpp"
#include "../laws/trials.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(evaluations_are_those_declared, M, methods) {
  using W = typename M::word;
  try_on<M, two_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    for (const std::int64_t n : {0, 1, 2, 17}) {
      BOOST_TEST(evaluations_of_run(system, method, step, x, n) ==
                 W::evaluations_to_open + n * W::evaluations_per_step);
    }
    BOOST_TEST(evaluations_of_step(system, method, step, x) == W::evaluations_of_plain_step);
  });
}

BOOST_AUTO_TEST_CASE(a_plain_step_of_verlet_costs_more_than_a_step_of_its_run) {
  const pendulum system;
  const phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  BOOST_TEST(evaluations_of_run(system, verlet(), 0.1, x, 10) == 11);
  BOOST_TEST(10 * evaluations_of_step(system, verlet(), 0.1, x) == 20);
}
