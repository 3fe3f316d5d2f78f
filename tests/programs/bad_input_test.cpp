// SPDX-License-Identifier: BSL-1.0
// What is typed wrong, and texts that are none.
#include <boost/test/unit_test.hpp>

#include <boost/test/data/test_case.hpp>

#include "../support/table.hpp"

BOOST_DATA_TEST_CASE(tables,
                     boost::unit_test::data::make({"bad_names", "bad_numbers", "bad_options",
                                                   "bad_input_in_bath"}),
                     name) {
  nysalt::test::run_table(name);
}
