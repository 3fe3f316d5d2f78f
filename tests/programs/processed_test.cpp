// SPDX-License-Identifier: BSL-1.0
// Processed methods, and what looks at their states cost.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(processed) { nysalt::test::run_table("processed"); }
