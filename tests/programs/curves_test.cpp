// SPDX-License-Identifier: BSL-1.0
// Schemes of several steps, and as many trajectories as are enough.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(curves) { nysalt::test::run_table("curves"); }
