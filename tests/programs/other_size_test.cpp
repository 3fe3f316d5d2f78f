// SPDX-License-Identifier: BSL-1.0
// Schemes at another size than they were learned for, and the digits of exports.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(other_size) { nysalt::test::run_table("other_size"); }
