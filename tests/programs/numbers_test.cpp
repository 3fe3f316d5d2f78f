// SPDX-License-Identifier: BSL-1.0
// Numbers that are known, and what they are worth.
#include <boost/test/unit_test.hpp>

#include <boost/test/data/test_case.hpp>

#include "../support/table.hpp"

BOOST_DATA_TEST_CASE(tables,
                     boost::unit_test::data::make({"known_values", "comparison", "acceptance_metric",
                                                   "stability"}),
                     name) {
  nysalt::test::run_table(name);
}
