// SPDX-License-Identifier: BSL-1.0
// Output files and their manifests.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(output_files) { nysalt::test::run_table("output_files"); }
