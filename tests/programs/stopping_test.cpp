// SPDX-License-Identifier: BSL-1.0
// What was stopped goes on to the bytes of a run that nothing happened to: run, sample, compare, learn and
// recommend, killed at some of their calls of the system; at all of them in
// tests/long/programs/stopping_test.cpp, at random times by tests/faults/kills.py.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../support/stopping.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(killed_it_goes_on_to_the_same_bytes) {
  for (const auto& one : stoppable_commands()) {
    const std::string expected = all_stops_come_to_the_same_bytes(
        one, [](int number, int count) { return number == (count + 2) / 2; });
    // Another seed has other bytes: so that equal bytes mean something. A classical method has no seed.
    if (expected.find("nysalt table") != std::string::npos) continue;
    const scratch folder("stopping_other");
    BOOST_TEST_REQUIRE(quietly(folder, one.line + " --seed 2 --output " + one.output).code == 0);
    BOOST_TEST((result_in(folder, one.output) != expected), one.line);
  }
}
