// SPDX-License-Identifier: BSL-1.0
// Numbers that are typed wrong.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(bad_numbers) { nysalt::test::run_table("bad_numbers"); }
