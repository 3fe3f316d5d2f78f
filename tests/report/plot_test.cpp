// SPDX-License-Identifier: BSL-1.0
// Pictures: data and script are written, and drawn where gnuplot is there.
#include <set>
#include <sstream>

#include "../../src/report/curve_drawing.hpp"
#include "../../src/report/plot.hpp"
#include "../../src/report/plot_script.hpp"
#include "../support/refusal.hpp"
#include "../support/scratch.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const bool has_gnuplot = std::system("gnuplot --version >/dev/null 2>&1") == 0;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

void has_all(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* one : words) BOOST_TEST(text.find(one) != std::string::npos, "missing: " << one);
}

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

/// All that is written in the picture of a panel.
std::multiset<std::string> words_in(const panel& plot) {
  const scratch folder("plot");
  BOOST_TEST_REQUIRE(draw({"picture", {plot}}, folder.path(), {"svg"}));
  const std::string svg = contents(folder / "picture.svg");
  std::multiset<std::string> result;
  for (std::size_t at = svg.find("<text>"); at != std::string::npos; at = svg.find("<text>", at)) {
    at = svg.find('>', at) + 1;
    const std::string word = svg.substr(at, svg.find('<', at) - at);
    result.insert(word.substr(std::min(word.find_first_not_of(' '), word.size())));
  }
  return result;
}

panel log_log(const std::vector<double>& x, const std::vector<double>& y) {
  panel plot{.title = "", .x_label = "", .y_label = "", .log_log = true, .curves = {}};
  plot.curves.push_back({.label = "", .x = x, .y = y});
  return plot;
}

}  // namespace

// Else a name could hold a command of gnuplot.
BOOST_AUTO_TEST_CASE(a_label_stays_on_its_line) {
  figure picture{.name = "picture", .panels = {{}}};
  picture.panels[0].title = "one\nsystem('id')";
  picture.panels[0].curves = {{.label = "two\r\nsystem('id')\n", .x = {1.0}, .y = {1.0}}};
  for (const std::string& text : {detail::plot_script(picture), detail::plot_data(picture)}) {
    BOOST_TEST(text.find("\nsystem") == std::string::npos, text);
    BOOST_TEST(text.find("system(") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(data_and_script_are_written_and_pictures_drawn) {
  const scratch folder("plot it's");
  BOOST_TEST(draw(two_panels(), folder.path()) == has_gnuplot);
  has_all(contents(folder / "picture.dat"),
          {"# it's a title: a\n0 1 0\n1 2 0\n2 1 0\n\n\n", "# errors: b\n1 0.01 0.001\n10 0.0001 0\n\n\n",
           "# errors: c\n"});
  has_all(contents(folder / "picture.gp"),
          {"'picture.dat' index 0", "'picture.dat' index 1", "'picture.dat' index 2", "set logscale y",
           "title 'it''s a title'", "multiplot"});
  if (has_gnuplot) {
    has_all(contents(folder / "picture.svg"), {"<svg"});
    BOOST_TEST(contents(folder / "picture.png").starts_with("\x89PNG"));
    BOOST_TEST(
        (folder.files() == std::set<std::string>{"picture.dat", "picture.gp", "picture.svg", "picture.png"}));
  }
  BOOST_TEST(refuses<std::runtime_error>([&] { draw(two_panels(), folder / "nowhere"); },
                                         {"cannot write", "picture.dat"}));
}

BOOST_AUTO_TEST_CASE(points_that_are_not_finite_leave_a_gap) {
  const double infinite = std::numeric_limits<double>::infinity();
  panel one;
  one.curves.push_back({"a", {0, 1, 2, 3, nothing, 5}, {1, nothing, 3, infinite, 4, 5}});
  const std::string gap = "NaN NaN NaN\n";  // where gnuplot breaks the line; a missing one would be bridged
  BOOST_TEST(detail::plot_data({"gaps", {one}}) ==
             "# : a\n0 1 0\n" + gap + "2 3 0\n" + gap + gap + "5 5 0\n\n\n");
}

BOOST_AUTO_TEST_CASE(points_that_do_not_count_are_hollow_and_only_they) {
  panel plot{.title = "", .x_label = "", .y_label = "", .log_log = true, .curves = {}};
  plot.curves.push_back({.label = "some", .x = {1, 2}, .y = {1, 2}, .hollow = {true, false}});
  plot.curves.push_back({.label = "all count", .x = {1, 2}, .y = {3, 4}, .hollow = {false, false}});
  const figure picture{"hollow", {plot}};
  BOOST_TEST(detail::plot_data(picture) ==
             "# : some\n1 1 0 1\n2 2 0 0\n\n\n# : all count\n1 3 0\n2 4 0\n\n\n");
  const auto script = detail::plot_script(picture);
  BOOST_TEST(script.find("index 0 using 1:($4 == 1 ? $2 : NaN):3") != std::string::npos);
  BOOST_TEST(script.find("index 0 using 1:2:3") == std::string::npos);
  BOOST_TEST(script.find("index 1 using 1:2:3") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(no_two_of_forty_curves_look_alike_without_their_colour_or_with_it) {
  panel plot;
  for (int j = 0; j < 40; ++j) plot.curves.push_back({fmt::format("{}", j), {0, 1}, {0, 1}});
  std::set<std::string> in_colour, in_grey;
  for (std::size_t j = 0; j < 40; ++j) {
    const auto seen = detail::style_of(plot, j);
    in_colour.insert(fmt::format("{} {}", seen.colour, seen.point));
    if (j < 30) in_grey.insert(fmt::format("{} {}", seen.point, seen.dash));
  }
  BOOST_TEST(in_colour.size() == 40U);
  BOOST_TEST(in_grey.size() == 30U);  // 6 shapes and 5 dashes
}

BOOST_AUTO_TEST_CASE(one_absurd_error_leaves_the_others_their_room) {
  if (!has_gnuplot) return;
  panel plot = log_log({1, 2, 3, 4}, {1e-1, 1e-3, 1e-5, 1e-7});
  const auto usual = words_in(plot);
  BOOST_TEST((usual.contains("1e-7") && usual.contains("1e-1") && !usual.contains("1e0")));
  plot.curves.push_back({"", {1, 2, 3}, {1e30, nothing, 0.0}});
  auto robust = words_in(plot);
  BOOST_TEST(robust.erase("1 beyond the frame") == 1U);
  BOOST_TEST(robust == usual, boost::test_tools::per_element());
  plot.levels = {{"", 1e3}};  // a level is always seen, and points up to ten times it
  BOOST_TEST(words_in(plot).contains("1 beyond the frame"));
  plot.curves[1].y[0] = 9e3;
  BOOST_TEST(!words_in(plot).contains("1 beyond the frame"));
}

// A panel of nothing that a logarithm has is drawn, with plain axes.
BOOST_AUTO_TEST_CASE(errors_of_zero_alone_are_drawn) {
  if (!has_gnuplot) return;
  BOOST_TEST(!words_in(log_log({1, 2}, {0.0, 0.0})).empty());
}

BOOST_AUTO_TEST_CASE(everything_that_a_curve_can_be_is_drawn) {
  const scratch folder("plot");
  panel plot{
      .title = "", .x_label = "", .y_label = "", .curves = {}, .points = true, .levels = {{"it's", 1.5}}};
  for (int j = 0; j < 8; ++j) {
    curve one{fmt::format("c{}", j), {1, 2, 3}, {1.0 + j, 2, 3}, {0.1, 0.1, 0.1}};
    one.dashed = j == 1;
    one.points_only = j == 2;
    one.front = j == 3;
    one.hollow = {j == 4, false, false};
    plot.curves.push_back(one);
  }
  panel log_x = plot;
  log_x.log_log = log_x.linear_y = true;
  panel log_xy = plot;
  log_xy.log_log = true;
  const figure picture{"all", {plot, log_x, log_xy}};
  BOOST_TEST(draw(picture, folder.path()) == has_gnuplot);
  const auto script = contents(folder / "all.gp");
  has_all(script, {"with steps", "nohead", "'it''s'", "keyentry with points"});
  // Points of size 0 are a matrix without an inverse, at which librsvg gives up.
  if (has_gnuplot) BOOST_TEST(contents(folder / "all.svg").find("scale(0.00)") == std::string::npos);
  has_all(script, {"title 'it''s'", "'hollow: not ranked'"});
  plot.curves[4].hollow = {};
  BOOST_TEST(detail::plot_script({"full", {plot}}).find("hollow: ") == std::string::npos);
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

BOOST_AUTO_TEST_CASE(intervals_are_shaded_behind_the_curves) {
  const scratch folder("plot");
  panel one;
  one.curves.push_back({"a", {0, 1, 2}, {1, 2, 1}});
  one.intervals = {{"calm", 0.0, 0.5}, {"calm", 1.0, 1.5}, {"it's wild", 0.25, 0.3}};
  panel other;
  other.curves.push_back({"b", {0, 1}, {1, 2}});
  BOOST_TEST(draw({"shaded", {one, other}}, folder.path()) == has_gnuplot);
  const auto script = contents(folder / "shaded.gp");
  has_all(script, {"set object 1 rectangle from first 0, graph 0 to first 0.5, graph 1 behind",
                   "set object 3 rectangle from first 0.25,", "title 'it''s wild'"});
  // A label has one entry in the key, and the next panel has none of it.
  BOOST_TEST(script.find("title 'calm'") == script.rfind("title 'calm'"));
  BOOST_TEST(script.find("unset object", script.find("set object 3")) != std::string::npos);
  BOOST_TEST(script.find("set object 4") == std::string::npos);
}

// gnuplot writes numbers beside powers of ten alone, and there may be none.
BOOST_AUTO_TEST_CASE(a_logarithmic_axis_always_has_numbers) {
  if (!has_gnuplot) return;
  for (const double low : {1.4, 2.3, 8.9, 0.0061}) {
    for (const double ratio : {1.0, 2.9, 60.0}) {
      panel plot = log_log({low, low * ratio}, {1e-3, 1e-7});
      plot.y_label = "y";
      const auto words = words_in(plot);
      const auto numbers = std::ranges::count_if(words, [&](const std::string& word) {
        return word.find('e') == std::string::npos && std::strtod(word.c_str(), nullptr) >= 0.5 * low;
      });
      BOOST_TEST(numbers >= 1 + (ratio > 3.0), low << " to " << low * ratio);  // 1, 2, 5: at most 2.5 apart
    }
  }
  const auto narrow = words_in(log_log({1.0, 1e3}, {2e-3, 2.1e-3}));
  BOOST_TEST((narrow.contains("2e-3") && narrow.contains("1e3") == false && narrow.contains("1000")));
}
