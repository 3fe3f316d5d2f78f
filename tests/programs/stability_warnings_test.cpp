// SPDX-License-Identifier: BSL-1.0
// Warnings of stability, and steps that were tried.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(stability) { nysalt::test::run_table("stability"); }
