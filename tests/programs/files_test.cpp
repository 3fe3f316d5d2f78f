// SPDX-License-Identifier: BSL-1.0
// What is read, written, protected, interrupted and gone on with.
#include <boost/test/unit_test.hpp>

#include <boost/test/data/test_case.hpp>

#include "../support/table.hpp"

BOOST_DATA_TEST_CASE(tables,
                     boost::unit_test::data::make({"checkpoints", "interruption", "output_files",
                                                   "protected_files", "unreadable_files"}),
                     name) {
  nysalt::test::run_table(name);
}
