// SPDX-License-Identifier: BSL-1.0
// The tables of command lines of nysalt_paper in cases/, each a test of ctest: long_paper_cases_NAME.
#include "../../support/table.hpp"

BOOST_AUTO_TEST_CASE(tables) { nysalt::test::run_tables_named(); }
