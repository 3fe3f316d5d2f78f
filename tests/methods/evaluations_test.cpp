// SPDX-License-Identifier: BSL-1.0
// Runs and steps of every method cost what is declared.
#include <boost/test/unit_test.hpp>

#include "../laws/run_laws.hpp"
#include "../laws/trials.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(evaluations_are_those_declared) {
  try_all_on<bound_systems>([](const auto& system, const auto& method, double step, const auto& x) {
    const auto& word = method.letters();
    for (const std::int64_t n : {0, 1, 2, 17}) {
      BOOST_TEST(evaluations_of_run(system, method, step, x, n) ==
                 word.evaluations_to_open + n * word.evaluations_per_step);
    }
    BOOST_TEST(evaluations_of_step(system, method, step, x) == word.evaluations_of_plain_step);
  });
}

BOOST_AUTO_TEST_CASE(gradient_kicks_cost_two) {
  const auto per_step = [](const auto& method) { return word_of(method).evaluations_per_step; };
  BOOST_TEST(per_step(takahashi_imada()) == 2);
  BOOST_TEST(per_step(chin4a()) == 3);
  BOOST_TEST(per_step(member<fg4>(fg4::start())) == 4);
  BOOST_TEST(per_step(member<r_fg4>(r_fg4::start())) == 4);
  BOOST_TEST(per_step(impulse()) == 1);
}

BOOST_AUTO_TEST_CASE(a_plain_step_of_verlet_costs_more_than_a_step_of_its_run) {
  const pendulum system;
  const phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  BOOST_TEST(evaluations_of_run(system, verlet(), 0.1, x, 10) == 11);
  BOOST_TEST(10 * evaluations_of_step(system, verlet(), 0.1, x) == 20);
}
