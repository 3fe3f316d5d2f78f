// SPDX-License-Identifier: BSL-1.0
// recommend and sample.
#include <boost/test/unit_test.hpp>

#include <boost/test/data/test_case.hpp>

#include "../support/table.hpp"

BOOST_DATA_TEST_CASE(tables,
                     boost::unit_test::data::make({"recommend", "recommend_left_out", "recommend_sampling",
                                                   "sample"}),
                     name) {
  nysalt::test::run_table(name);
}
