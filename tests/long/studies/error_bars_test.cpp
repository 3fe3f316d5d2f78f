// SPDX-License-Identifier: BSL-1.0
// Error bars cover, or are marked: a small form of the table of ./dev error-bars.
#include "../../../bench/studies/error_bars/coverage.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>

using namespace nysalt::coverage;

namespace {

const std::vector<row>& rows() {
  static const std::vector<row> all = covered_rows({.systems = {"pendulum", "linear_chain", "henon_heiles"},
                                                    .methods = {"verlet", "srkn6b"},
                                                    .angles = {0.16},
                                                    .turns = 20.0,
                                                    .of_sample = 200,
                                                    .many = 8'000,
                                                    .between = {100, 1'000}});
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(error_bars_cover_or_are_marked) {
  BOOST_REQUIRE(rows().size() == 3U * 2U * 4U);
  for (const row& line : rows()) {
    BOOST_TEST_CONTEXT(line.system << ", " << line.metric << ", " << line.method << ": " << line.covered) {
      BOOST_TEST((line.covers() || line.has_tail()));
      BOOST_TEST(line.agrees);
    }
  }
}

// Error bars of the pendulum, where starts lie near the separatrix, do not cover; of a linear chain no state
// has a tail.
BOOST_AUTO_TEST_CASE(marks_are_neither_on_all_nor_on_none) {
  const auto is_of = [](const char* system, const char* metric) {
    return [=](const row& line) { return line.system == system && line.metric == metric; };
  };
  const auto count = [](const auto& is_wanted, const auto& is_so) {
    return std::ranges::count_if(rows(), [&](const row& line) { return is_wanted(line) && is_so(line); });
  };
  const auto has_tail = [](const row& line) { return line.has_tail(); };
  BOOST_TEST(count(is_of("pendulum", "state"), has_tail) == 2);
  BOOST_TEST(count(is_of("pendulum", "state"), [](const row& line) { return !line.covers(); }) > 0);
  BOOST_TEST(count(is_of("linear_chain", "state"), has_tail) == 0);
}

BOOST_AUTO_TEST_CASE(a_table_says_what_is_wrong) {
  row bad = rows().front();
  bad.truth_has_tail = false;
  bad.marked = 0;
  bad.covered = 5;
  BOOST_TEST(page_of({bad}, {}).find("NOT SO") != std::string::npos);
  BOOST_TEST(csv_of({bad}).find(",5,0,") != std::string::npos);
}
