// SPDX-License-Identifier: BSL-1.0
// What stability windows promise, long runs keep.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../laws/stability_law.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(long_runs_stay_bounded_inside_and_diverge_outside, M, methods) {
  draws random;
  const auto method = any_method<M>(random);
  BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
    try_ends(
        method, 1e-3, 0.5,  // in the middle of a narrow gap, where 100,000 steps suffice
        [&](double z) { BOOST_TEST(largest_in_long_run(method, z) <= bound_of_long_run(method, z)); },
        [&](double z) { BOOST_TEST(!(largest_in_long_run(method, z) <= 1e9)); });
  }
}
