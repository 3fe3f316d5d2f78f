// SPDX-License-Identifier: BSL-1.0
// Schemes of several steps, as many trajectories as are enough, and schemes at another size.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

using nysalt::test::run_table;

BOOST_AUTO_TEST_CASE(curves) { run_table("curves"); }
BOOST_AUTO_TEST_CASE(other_size) { run_table("other_size"); }
