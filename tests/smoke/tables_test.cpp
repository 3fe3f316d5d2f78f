// SPDX-License-Identifier: BSL-1.0
// One short run of each thing that is otherwise long: tables of command lines that start compilers and
// mpirun.
#include "../support/table.hpp"

BOOST_AUTO_TEST_CASE(tables) { nysalt::test::run_tables_named(); }
