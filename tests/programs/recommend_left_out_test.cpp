// SPDX-License-Identifier: BSL-1.0
// Who is left out by recommend, and why.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(recommend_left_out) { nysalt::test::run_table("recommend_left_out"); }
