// SPDX-License-Identifier: BSL-1.0
// What is typed wrong of a bath, of placements and of statistics.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(bad_input_in_bath) { nysalt::test::run_table("bad_input_in_bath"); }
