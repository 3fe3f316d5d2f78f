// SPDX-License-Identifier: BSL-1.0
// Methods: from files, learned at several steps or for another size, processed, exported.
#include <boost/test/unit_test.hpp>

#include <boost/test/data/test_case.hpp>

#include "../support/table.hpp"

BOOST_DATA_TEST_CASE(tables,
                     boost::unit_test::data::make({"method_files", "curves", "other_size", "processed",
                                                   "export"}),
                     name) {
  nysalt::test::run_table(name);
}
