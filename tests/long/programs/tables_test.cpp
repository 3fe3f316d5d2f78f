// SPDX-License-Identifier: BSL-1.0
// Rows that compile plug-ins or run for long. Tier 1 has tests/smoke/cases, the refusal of
// prices for a system without parts in bad_options.txt, and short motion in comparison.txt and stability.txt.
#include "../../support/table.hpp"

BOOST_AUTO_TEST_CASE(tables) { nysalt::test::run_tables_named(); }
