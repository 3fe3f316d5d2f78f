// SPDX-License-Identifier: BSL-1.0
// What is printed: documents, exit codes, defaults, options from files, citations.
#include <boost/test/unit_test.hpp>

#include <boost/test/data/test_case.hpp>

#include "../support/table.hpp"

BOOST_DATA_TEST_CASE(tables,
                     boost::unit_test::data::make({"contract", "exit_codes", "defaults", "config_file",
                                                   "cite", "potential"}),
                     name) {
  nysalt::test::run_table(name);
}
