// SPDX-License-Identifier: BSL-1.0
// Tables as text, Markdown and CSV, and those of work and precision.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "../../src/report/table.hpp"
#include "../../src/report/work_precision.hpp"
#include "../support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
table example() {
  table t({"method", "error"});
  t.add({"verlet", "2e-2"});
  t.add({"x", "0.00039"});
  return t;
}
}  // namespace

BOOST_AUTO_TEST_CASE(text_is_aligned_names_left_and_numbers_right) {
  BOOST_TEST(example().text() ==
             "method    error\n"
             "------  -------\n"
             "verlet     2e-2\n"
             "x       0.00039\n");
}

BOOST_AUTO_TEST_CASE(markdown_is_a_table) {
  BOOST_TEST(example().markdown() ==
             "| method |   error |\n"
             "| ------ | ------- |\n"
             "| verlet |    2e-2 |\n"
             "| x      | 0.00039 |\n");
}

BOOST_AUTO_TEST_CASE(csv_quotes_what_must_be_quoted_and_nothing_else) {
  table t({"plain", "with, comma"});
  t.add({"say \"hi\"", "two\nlines"});
  t.add({"a;b c", ""});
  BOOST_TEST(t.csv() ==
             "plain,\"with, comma\"\n"
             "\"say \"\"hi\"\"\",\"two\nlines\"\n"
             "a;b c,\n");
  BOOST_TEST(example().csv() == "method,error\nverlet,2e-2\nx,0.00039\n");
}

BOOST_AUTO_TEST_CASE(csv_has_no_cell_that_a_spreadsheet_computes) {
  for (const std::string cell :
       {"=1+1", "=cmd|x!A1", " =1", "\t@1", "@1", "+1.json", "-1+2", "-.5x", "=.5", "+inf+1", "--1", "+"}) {
    table t({"a"});
    t.add({cell});
    const std::string safe = cell.size() > 1 ? "'" + cell : cell;  // a sign by itself is none
    BOOST_TEST(t.csv() == "a\n" + safe + '\n', cell);
  }
  for (const std::string number : {"-1", "+1", "-1e-3", "+.5", "-inf", "+nan", "-nan", "1e400", "-1e-400"}) {
    table t({"a"});
    t.add({number});
    BOOST_TEST(t.csv() == "a\n" + number + '\n');
  }
}

BOOST_AUTO_TEST_CASE(no_rows_are_a_head_alone) {
  const table t({"a", "b"});
  BOOST_TEST(t.csv() == "a,b\n");
  BOOST_TEST(t.text() == "a  b\n-  -\n");
}

BOOST_AUTO_TEST_CASE(a_row_has_a_cell_for_each_column) {
  auto t = example();
  for (const auto& cells : {std::vector<std::string>{"one"}, std::vector<std::string>{"1", "2", "3"}, {}}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { t.add(cells); },
                                              {fmt::format("{} cells", cells.size()), "2 columns"}));
  }
  BOOST_TEST(t.csv() == example().csv());
}

namespace {

work_precision_row at_cost(const std::string& method, double evaluations, double error,
                           std::int64_t diverged = 0) {
  return {method, 2.0 / evaluations, evaluations, 1e-9 * evaluations, {error, 0.1 * error}, diverged, 40};
}
/// Errors that fall with the square of the cost, out of order, beside another method's.
std::vector<work_precision_row> power_law() {
  return {at_cost("a", 400, 7 * std::pow(400, -2)), at_cost("b", 200, 99.0),
          at_cost("a", 100, 7 * std::pow(100, -2)), at_cost("a", 1600, 7 * std::pow(1600, -2))};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_table_has_cost_and_error_side_by_side) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto csv = work_precision_table({at_cost("a", 200, 0.0123), at_cost("b", 50, nan, 40)}).csv();
  BOOST_TEST(csv ==
             "method,step,evaluations/time,ns/time,error,standard error,diverged\n"
             "a,0.01,200.0,200,1.23e-02,1.23e-03,0/40\n"
             "b,0.04,50.0,50,-,-,40/40\n");
}

BOOST_AUTO_TEST_CASE(the_panel_has_a_curve_for_each_method) {
  const auto by_evaluations =
      work_precision_panel(power_law(), "b", "cost", &work_precision_row::evaluations_per_time);
  BOOST_REQUIRE(by_evaluations.curves.size() == 2);
  BOOST_TEST(by_evaluations.log_log);
  BOOST_TEST(by_evaluations.x_label == "cost");
  BOOST_TEST(by_evaluations.curves[0].label == "a");
  BOOST_TEST(!by_evaluations.curves[0].emphasised);
  BOOST_TEST(by_evaluations.curves[1].emphasised);
  BOOST_TEST(by_evaluations.curves[0].x == (std::vector<double>{100, 400, 1600}),
             boost::test_tools::per_element());
  BOOST_TEST(by_evaluations.curves[1].y == (std::vector<double>{99}), boost::test_tools::per_element());
  BOOST_TEST(by_evaluations.curves[1].error == (std::vector<double>{9.9}), boost::test_tools::per_element());
  const auto by_seconds =
      work_precision_panel(power_law(), "b", "time", &work_precision_row::seconds_per_time);
  BOOST_TEST(by_seconds.curves[1].x[0] == 1e-9 * 200);
}

BOOST_AUTO_TEST_CASE(what_is_learned_is_emphasised_and_what_does_not_count_is_hollow) {
  auto rows = power_law();
  rows[1].learned = true;
  rows[2].counts = false;  // the cheapest of method a
  const auto plot = work_precision_panel(rows, "", "cost", &work_precision_row::evaluations_per_time);
  BOOST_TEST(!plot.curves[0].emphasised);
  BOOST_TEST(plot.curves[1].emphasised);
  BOOST_TEST((plot.curves[0].hollow == std::vector<bool>{true, false, false}));
  BOOST_TEST((plot.curves[1].hollow == std::vector<bool>{false}));
}

BOOST_AUTO_TEST_CASE(a_front_goes_from_cheap_to_dear) {
  const auto front = front_curve(power_law(), {3, 0, 2}, &work_precision_row::evaluations_per_time);
  BOOST_TEST(front.front);
  BOOST_TEST(front.x == (std::vector<double>{100, 400, 1600}), boost::test_tools::per_element());
  BOOST_TEST(front.y[2] == 7 * std::pow(1600, -2));
  BOOST_CHECK_THROW(front_curve(power_law(), {4}, &work_precision_row::evaluations_per_time),
                    std::out_of_range);
}
