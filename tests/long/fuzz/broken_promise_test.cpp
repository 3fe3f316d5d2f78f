// SPDX-License-Identifier: BSL-1.0
// What the fuzz targets hold the program to: each promise, and a run that breaks it.
#include <boost/test/unit_test.hpp>

#include "program_run.hpp"

using nysalt::fuzz::broken_promise;
using nysalt::fuzz::remains;

namespace {

const std::set<std::string> before{"scheme.json"};
const std::string line = "nysalt: scheme.json must be whole JSON\n";
const remains refused{2, "", line, before};
const remains done{0, "rows", "", {"scheme.json", "out.csv"}};

bool breaks(remains left, auto&& change) {
  change(left);
  return !broken_promise(left, before).empty();
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_refusal_and_a_result_keep_all_promises_and_what_breaks_one_is_found) {
  BOOST_TEST(broken_promise(refused, before) == "");
  BOOST_TEST(broken_promise(done, before) == "");
  const std::set<std::string> stopped{"out.csv.work", "out.csv.part"};  // a run that cannot be gone on with
  BOOST_TEST(broken_promise({2, "", line, stopped}, stopped) == "");
  BOOST_TEST(breaks(done, [](remains& left) { left.code = 1; }));
  BOOST_TEST(breaks(done, [](remains& left) { left.code = 139; }));
  BOOST_TEST(breaks(done, [](remains& left) { left.files.insert("out.csv.17.part"); }));
  BOOST_TEST(breaks(refused, [](remains& left) { left.err = ""; }));
  BOOST_TEST(breaks(refused, [](remains& left) { left.err = "terminate called\n"; }));
  BOOST_TEST(breaks(refused, [](remains& left) { left.err += left.err; }));
  BOOST_TEST(breaks(refused, [](remains& left) { left.err.insert(9, "\033[K"); }));
  BOOST_TEST(breaks(refused, [](remains& left) { left.out = "trajectory,step,t\n"; }));
  BOOST_TEST(breaks(refused, [](remains& left) { left.files.insert("out.csv"); }));
  BOOST_TEST(breaks(refused, [](remains& left) { left.files.clear(); }));
  BOOST_TEST(breaks(refused, [](remains& left) { left.inputs_are_whole = false; }));
}
