// SPDX-License-Identifier: BSL-1.0
// Methods on disk.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(method_files) { nysalt::test::run_table("method_files"); }
