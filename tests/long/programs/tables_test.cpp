// SPDX-License-Identifier: BSL-1.0
// Rows that compile plug-ins or run for long. Tier 1 has tests/smoke/own_systems_test.cpp, the refusal of
// prices for a system without parts in bad_options.txt, and short motion in comparison.txt and stability.txt.
#include <boost/test/unit_test.hpp>

#include <boost/test/data/test_case.hpp>

#include "../../support/table.hpp"

BOOST_DATA_TEST_CASE(tables, boost::unit_test::data::make({"own_systems", "letters", "prices"}), name) {
  nysalt::test::run_table(name);
}
