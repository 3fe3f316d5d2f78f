// SPDX-License-Identifier: BSL-1.0
// compare --metric acceptance; its numbers are in values_test.cpp.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(acceptance_metric) { nysalt::test::run_table("acceptance_metric"); }
