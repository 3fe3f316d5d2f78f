// SPDX-License-Identifier: BSL-1.0
// Numbers that are typed wrong, and comparisons of acceptances.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

using nysalt::test::run_table;

BOOST_AUTO_TEST_CASE(bad_numbers) { run_table("bad_numbers"); }
BOOST_AUTO_TEST_CASE(acceptance_metric) { run_table("acceptance_metric"); }
