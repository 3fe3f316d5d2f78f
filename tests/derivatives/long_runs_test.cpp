// SPDX-License-Identifier: BSL-1.0
// What stability windows promise, long runs keep.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../laws/stability_law.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(long_runs_stay_bounded_inside_and_diverge_outside) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    if (has_rotation(method.letters())) continue;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
      try_ends(
          method, 1e-3, 0.5,  // in the middle of a narrow gap, where 100,000 steps suffice
          [&](double z) { BOOST_TEST(largest_in_long_run(method, z) <= bound_of_long_run(method, z)); },
          [&](double z) { BOOST_TEST(!(largest_in_long_run(method, z) <= 1e9)); });
    }
  }
}
