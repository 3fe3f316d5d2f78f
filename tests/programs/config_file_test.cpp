// SPDX-License-Identifier: BSL-1.0
// Options from a TOML file.
#include <boost/test/unit_test.hpp>

#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(config_file) { nysalt::test::run_table("config_file"); }
