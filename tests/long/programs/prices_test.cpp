// SPDX-License-Identifier: BSL-1.0
// Prices of the parts of a plug-in's force; tier 1 has the refusal for a system without parts in
// bad_options.txt.
#include <boost/test/unit_test.hpp>

#include "../../support/table.hpp"

BOOST_AUTO_TEST_CASE(prices) { nysalt::test::run_table("prices"); }
