// SPDX-License-Identifier: BSL-1.0
// Killed at any of its calls of the system, a command goes on to the same bytes. In tier 1: some of these
// calls, in tests/programs/stopping_test.cpp.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../../support/stopping.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(killed_at_any_call_it_goes_on_to_the_same_bytes) {
  for (const auto& one : stoppable_commands())
    all_stops_come_to_the_same_bytes(one, [](int, int) { return true; });
}
