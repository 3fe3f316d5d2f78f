// SPDX-License-Identifier: BSL-1.0
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include "../../src/report/table.hpp"
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
