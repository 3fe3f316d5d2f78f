// SPDX-License-Identifier: BSL-1.0
// nysalt cite.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(cite) { nysalt::test::run_table("cite"); }
