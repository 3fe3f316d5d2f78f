// SPDX-License-Identifier: BSL-1.0
// Options, files and outputs that cannot be.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(bad_options) { nysalt::test::run_table("bad_options"); }
