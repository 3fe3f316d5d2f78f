// SPDX-License-Identifier: BSL-1.0
// Pictures: data and script are written, and drawn where gnuplot is there.
#include <boost/test/unit_test.hpp>

#include <cstdlib>
#include <limits>
#include <sstream>

#include "../support/refusal.hpp"
#include "../support/scratch.hpp"
#include "nysalt/report/plot.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const bool has_gnuplot = std::system("gnuplot --version >/dev/null 2>&1") == 0;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

figure two_panels() {
  const panel lines{
      .title = "it's a title", .x_label = "t", .y_label = "I", .curves = {{"a", {0, 1, 2}, {1, 2, 1}}}};
  const panel points{
      .title = "errors",
      .x_label = "cost",
      .y_label = "error",
      .log_log = true,
      .curves = {{"b", {1, 10}, {1e-2, 1e-4}, {1e-3, nothing}, true}, {"c", {1, 10}, {1e-1, 1e-3}}}};
  return {"picture", {lines, points}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(data_and_script_are_written_and_pictures_drawn) {
  const scratch folder("plot it's");
  BOOST_TEST(draw(two_panels(), folder.path()) == has_gnuplot);
  const auto data = contents(folder / "picture.dat");
  BOOST_TEST(data.find("# it's a title: a\n0 1 0\n1 2 0\n2 1 0\n\n\n") != std::string::npos);
  BOOST_TEST(data.find("# errors: b\n1 0.01 0.001\n10 0.0001 0\n\n\n") != std::string::npos);
  BOOST_TEST(data.find("# errors: c\n") != std::string::npos);
  const auto script = contents(folder / "picture.gp");
  for (const char* words : {"'picture.dat' index 0", "'picture.dat' index 1", "'picture.dat' index 2",
                            "logscale xy", "title 'it''s a title'", "multiplot"}) {
    BOOST_TEST(script.find(words) != std::string::npos, "missing: " << words);
  }
  if (has_gnuplot) {
    BOOST_TEST(contents(folder / "picture.svg").find("<svg") != std::string::npos);
    BOOST_TEST(contents(folder / "picture.png").starts_with("\x89PNG"));
    BOOST_TEST(
        (folder.files() == std::set<std::string>{"picture.dat", "picture.gp", "picture.svg", "picture.png"}));
  }
}

BOOST_AUTO_TEST_CASE(points_that_are_not_finite_leave_a_gap) {
  const scratch folder("plot");
  const double infinite = std::numeric_limits<double>::infinity();
  panel one;
  one.curves.push_back({"a", {0, 1, 2, 3, nothing, 5}, {1, nothing, 3, infinite, 4, 5}});
  draw({"gaps", {one}}, folder.path());
  std::istringstream lines(contents(folder / "gaps.dat"));
  std::vector<std::string> read;
  for (std::string line; std::getline(lines, line);) read.push_back(line);
  const std::string gap = "NaN NaN NaN";  // where gnuplot breaks the line; a missing one would be bridged
  BOOST_TEST(read == (std::vector<std::string>{"# : a", "0 1 0", gap, "2 3 0", gap, gap, "5 5 0", "", ""}),
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(a_folder_that_is_not_there_is_told) {
  const scratch folder("plot");
  BOOST_TEST(refuses<std::runtime_error>([&] { draw(two_panels(), folder / "nowhere"); },
                                         {"cannot write", "picture.dat"}));
  BOOST_TEST(folder.files().empty());
}

BOOST_AUTO_TEST_CASE(what_gnuplot_cannot_draw_leaves_no_half_picture) {
  const scratch folder("plot");
  panel bad;
  bad.curves.push_back({"a", {0, 1}, {0, 1}});
  bad.y_range = "nonsense";
  BOOST_TEST(!draw({"bad", {bad}}, folder.path()));
  BOOST_TEST((folder.files() == std::set<std::string>{"bad.dat", "bad.gp"}));
}

BOOST_AUTO_TEST_CASE(no_old_picture_stays_beside_new_data) {
  const scratch folder("plot");
  for (const char* name : {"bad.svg", "bad.png", "good.svg"}) write_file(folder / name, "old");
  panel bad;
  bad.curves.push_back({"a", {0, 1}, {0, 1}});
  bad.y_range = "nonsense";
  BOOST_TEST(!draw({"bad", {bad}}, folder.path()));
  BOOST_TEST((folder.files() == std::set<std::string>{"bad.dat", "bad.gp", "good.svg"}));
}

BOOST_AUTO_TEST_CASE(names_hold_nothing_that_a_shell_reads) {
  const scratch folder("plot");
  panel one;
  one.curves.push_back({"a", {0, 1}, {0, 1}});
  for (const char* name : {"", "a b", "../a", "a.b", "it's", "$(touch x)", "a;b", "a\nb", "\xc3\xa4"}) {
    BOOST_TEST(refuses<std::invalid_argument>(
        [&] {
          draw({name, {one}}, folder.path());
        },
        {"name of a figure", "letters, digits", name}));
  }
  BOOST_TEST(folder.files().empty());
  for (const char* name : {"A-z_09", "-V"}) {  // the last would be an option of gnuplot
    BOOST_TEST(draw({name, {one}}, folder.path()) == has_gnuplot);
    BOOST_TEST(folder.files().contains(std::string(name) + ".svg") == has_gnuplot);
  }
}
