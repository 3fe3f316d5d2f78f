// SPDX-License-Identifier: BSL-1.0
// The tables of command lines in cases/, each a test of ctest: programs_cases_NAME.
#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(tables) { nysalt::test::run_tables_named(); }
