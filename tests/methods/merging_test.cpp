// SPDX-License-Identifier: BSL-1.0
// A run, whose letters are merged, is where repeated plain steps are, to rounding.
#include <boost/test/unit_test.hpp>

#include "../laws/run_laws.hpp"
#include "../laws/trials.hpp"

using namespace nysalt;
using namespace nysalt::test;

using a_few = std::tuple<a_free_chain, an_fpu_chain, a_galaxy, two_split_weights, a_fast_one>;

BOOST_AUTO_TEST_CASE(merged_is_unmerged_to_rounding) {
  try_all_on<a_few>([](const auto& system, const auto& method, double step, const auto& x) {
    BOOST_TEST(merging_broken(system, method, step, x, 30) <= 1.0);
  });
}

// A run that is not made synchronous before it is looked at is ahead by a letter.
BOOST_AUTO_TEST_CASE(an_open_run_is_not_where_the_plain_step_is) {
  try_on<verlet, a_few>([](const auto& system, const auto& method, double step, const auto& x) {
    const auto fixed = make_stepper(system, method, step);
    const auto run = fixed.open(x);
    const double rounding = 4.0 * eps * size_of(x) * shears_at(system, x).frequency();
    BOOST_TEST(distance(fixed.synchronous(run), x) <= rounding);
    BOOST_TEST(distance({run.state.q, run.state.p}, x) > 1e6 * rounding);
  });
}
