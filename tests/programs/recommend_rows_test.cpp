// SPDX-License-Identifier: BSL-1.0
// Who is named the winner by recommend, and what is refused.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(recommend) { nysalt::test::run_table("recommend"); }
