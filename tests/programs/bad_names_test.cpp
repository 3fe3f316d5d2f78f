// SPDX-License-Identifier: BSL-1.0
// Names that are typed wrong (cases/bad_names.txt).
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(bad_names) { nysalt::test::run_table("bad_names"); }
