// SPDX-License-Identifier: BSL-1.0
// Defaults of the commands.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(defaults) { nysalt::test::run_table("defaults"); }
