// SPDX-License-Identifier: BSL-1.0
// Pages and their tables say what they were told, in Markdown, in HTML and as CSV; a page needs nothing but
// itself.
#include <regex>
#include <set>

#include "../../src/report/page.hpp"
#include "../../src/report/table.hpp"
#include "../../src/report/work_precision.hpp"
#include "../support/refusal.hpp"
#include "../support/scratch.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const std::string nasty = "<b>&\"'";

/// As gnuplot writes: a prolog, titles, empty groups, ids that are used, one that is not and stands twice.
const std::string svg = R"svg(<?xml version="1.0"?>
<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">
<svg width="8" viewBox="0 0 8 5" xmlns="http://www.w3.org/2000/svg">
<title>Gnuplot</title>
<defs><circle id='dot' r='1'/><clipPath id="clip"><rect/></clipPath></defs>
<g id="gnuplot_plot_1" ><title>gnuplot_plot_1</title>
<g fill="none">
</g>
<use xlink:href='#dot'/><path clip-path="url(#clip)"/><text> id='y' url(#z) #dot</text></g>
<g id="gnuplot_plot_1"><path/></g>
</svg>
)svg";

figure named(const std::string& name) { return {name, {}}; }

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

std::multiset<std::string> matches(const std::string& text, const char* pattern) {
  const std::regex expression(pattern);
  std::multiset<std::string> result;
  for (std::sregex_iterator i(text.begin(), text.end(), expression); i != std::sregex_iterator(); ++i) {
    result.insert((*i)[1]);
  }
  return result;
}

page example() {
  page report("Speed, `x_1` <now>");
  report.verdict("Best is `a`.");
  report.heading("One");
  report.text("See **this** and [that](a/b.md): 2 * 3 < `a*b`.");
  report.list({"first", "second"});
  nysalt::table cells({"method", "error"});
  cells.add({"a|b", "1e-3"});
  report.table(cells);
  report.subheading("Two");
  report.code("nysalt compare");
  report.picture(named("p"), "A [picture].");
  return report;
}

nysalt::table cells() {
  nysalt::table t({"method", "error"});
  t.add({"verlet", "2e-2"});
  t.add({"x", "0.00039"});
  return t;
}

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

BOOST_AUTO_TEST_CASE(markdown_is_as_expected) {
  BOOST_TEST(example().markdown("pictures") ==
             "# Speed, `x_1` \\<now\\>\n"
             "\nBest is `a`.\n"
             "\n## One\n"
             "\nSee **this** and [that](a/b.md): 2 \\* 3 \\< `a*b`.\n"
             "\n- first\n- second\n"
             "\n| method | error |\n| ------ | ----- |\n| a\\|b   |  1e-3 |\n"
             "\n### Two\n"
             "\n```\nnysalt compare\n```\n"
             "\n![A \\[picture\\].](pictures/p.svg)\n\nA \\[picture\\].\n");
  BOOST_TEST(has(example().markdown(), "](p.svg)"));
  page with_backquotes("t");
  with_backquotes.code("```\n");
  BOOST_TEST(has(with_backquotes.markdown(), "\n````\n```\n````\n"));
}

BOOST_AUTO_TEST_CASE(html_says_the_same) {
  const scratch folder("page");
  write_file(folder / "p.svg", svg);
  const auto html = example().html(folder.path());
  for (const char* words :
       {"<!DOCTYPE html>", "<title>Speed, x_1 &lt;now&gt;</title>",
        "<h1>Speed, <code>x_1</code> &lt;now&gt;</h1>", "<p class=\"verdict\">Best is <code>a</code>.</p>",
        "<p>See <strong>this</strong> and <a href=\"a/b.md\">that</a>: 2 * 3 &lt; <code>a*b</code>.</p>",
        "<li>first</li>\n<li>second</li>", "<th class=\"number\">error</th>",
        "<td class=\"\" data-column=\"method\">a|b</td><td class=\"number\" data-column=\"error\">1e-3</td>",
        "<pre><code>nysalt compare</code></pre>", "alt=\"A [picture].\">",
        "<img src=\"data:image/svg+xml;base64,PD94bWwg", "<figcaption>A [picture].</figcaption>"}) {
    BOOST_TEST(has(html, words), "missing: " << words);
  }
  BOOST_TEST(!has(html, "<nav"));
}

BOOST_AUTO_TEST_CASE(what_looks_like_a_tag_is_text_wherever_it_stands) {
  const scratch folder("page");
  write_file(folder / "p.svg", svg);
  page report(nasty);
  report.heading(nasty);
  report.subheading(nasty);
  report.text(nasty + " `" + nasty + "` **" + nasty + "** [" + nasty + "](x?\"'&<)");
  report.text("[a](javascript:alert(1)) and [b](https://example.org/c) and [open](");
  report.list({nasty});
  nysalt::table cells({nasty, nasty});
  cells.add({nasty, nasty});
  report.table(cells);
  report.code(nasty);
  report.picture(named("p"), nasty);
  const auto html = report.html(folder.path());
  BOOST_TEST(!has(html, "<b>"));
  BOOST_TEST(!has(html, "&\""));
  BOOST_TEST(has(html, "alt=\"&lt;b&gt;&amp;&quot;&apos;\""));
  BOOST_TEST((matches(html, "href=\"([^\"]*)\"") ==
              std::multiset<std::string>{"x?&quot;&apos;&amp;&lt;", "https://example.org/c"}));
  BOOST_TEST(has(html, "[a](javascript:"));  // a link that would run something is no link
}

BOOST_AUTO_TEST_CASE(no_address_of_anything_outside_is_in_a_page) {
  const scratch folder("page");
  page report("t");
  panel one;
  one.curves.push_back({nasty, {0, 1}, {0, 1}});
  report.picture({"p", {one, one}}, "c");
  const bool drawn = draw(report.figures()[0], folder.path());
  const auto html = report.html(folder.path());
  BOOST_TEST(has(html, "<img src=\"data:image/svg+xml;base64,") == drawn);
  BOOST_TEST(matches(html, "(https?:)").empty());
  BOOST_TEST(!has(html, "<b>"));
  const auto ids = matches(html, " id=[\"']([^\"']*)[\"']");
  BOOST_TEST((ids.size() == std::set<std::string>(ids.begin(), ids.end()).size()));
  BOOST_TEST(has(html, "Content-Security-Policy\" content=\"default-src 'none';"));
  BOOST_TEST(matches(html, " src=\"([a-z]*)").count("data") == matches(html, "( src=)").size());
}

// Without its hash in the policy a browser does not run the script.
BOOST_AUTO_TEST_CASE(the_policy_allows_the_script_of_the_page_and_no_other) {
  const scratch folder("policy");
  const auto html = example().html(folder.path());
  const auto allowed = matches(html, "script-src ('[^;\"]*);");
  BOOST_TEST_REQUIRE(allowed.size() == 1U);
  const std::size_t from = html.find("<script>") + 8;
  const auto hash_of = [&](const std::string& script) {
    write_file(folder / "script", script);
    const std::string command =
        "cd '" + folder.path().string() +
        "' && python3 -c \"import base64, hashlib; data = open('script', 'rb').read(); "
        "print(base64.b64encode(hashlib.sha256(data).digest()).decode(), end='')\" >hash";
    BOOST_TEST_REQUIRE(std::system(command.c_str()) == 0);
    return "'sha256-" + contents(folder / "hash") + "'";
  };
  const std::string script = html.substr(from, html.find("</script>") - from);
  BOOST_TEST(*allowed.begin() == hash_of(script));
  BOOST_TEST(*allowed.begin() != hash_of(script + " "));
  for (const char* rule : {"default-src 'none';", "base-uri 'none'", "form-action 'none'"}) {
    BOOST_TEST(has(html, rule), "missing: " << rule);
  }
}

BOOST_AUTO_TEST_CASE(a_missing_picture_is_a_sentence) {
  const scratch folder("page");
  for (const char* text : {"", "<svg", "</svg>", "</svg><svg>"}) {
    write_file(folder / "p.svg", text);
    BOOST_TEST(has(example().html(folder.path()), "The picture p is missing"));
  }
  BOOST_TEST(has(example().html(folder / "nowhere"), "The picture p is missing"));
}

BOOST_AUTO_TEST_CASE(more_than_three_sections_have_a_list_of_contents) {
  page report("t");
  report.text("The verdict.");
  for (const char* name : {"a", "b", "c"}) report.heading(name);
  report.subheading("below");
  BOOST_TEST(!has(report.html("."), "<nav"));
  report.heading("`d`");
  const auto html = report.html(".");
  BOOST_TEST(has(html, "<a href=\"#section-5\">d</a>"));
  BOOST_TEST(has(html, "<h2 id=\"section-5\"><code>d</code></h2>"));
  BOOST_TEST(!has(html, "#section-4"));
  // What is above the sections is above the list.
  BOOST_TEST(html.find("The verdict.") < html.find("<nav"));
  BOOST_TEST(html.find("<nav") < html.find("<h2"));
}

BOOST_AUTO_TEST_CASE(two_pictures_of_one_name_are_refused) {
  auto report = example();
  BOOST_TEST(refuses<std::invalid_argument>([&] { report.picture(named("p"), "c"); },
                                            {"pictures must have different names", "got p twice"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { report.picture(named("../p"), "c"); }, {"letters"}));
  BOOST_TEST(report.figures().size() == 1U);
}

BOOST_AUTO_TEST_CASE(a_table_is_text_and_markdown_names_left_and_numbers_right) {
  BOOST_TEST(cells().text() ==
             "method    error\n"
             "------  -------\n"
             "verlet     2e-2\n"
             "x       0.00039\n");
  BOOST_TEST(cells().markdown() ==
             "| method |   error |\n"
             "| ------ | ------- |\n"
             "| verlet |    2e-2 |\n"
             "| x      | 0.00039 |\n");
  BOOST_TEST(table({"a", "b"}).text() == "a  b\n-  -\n");
}

BOOST_AUTO_TEST_CASE(csv_quotes_what_must_be_quoted_and_nothing_else) {
  table t({"plain", "with, comma"});
  t.add({"say \"hi\"", "two\nlines"});
  t.add({"a;b c", ""});
  BOOST_TEST(t.csv() ==
             "plain,\"with, comma\"\n"
             "\"say \"\"hi\"\"\",\"two\nlines\"\n"
             "a;b c,\n");
  BOOST_TEST(cells().csv() == "method,error\nverlet,2e-2\nx,0.00039\n");
}

BOOST_AUTO_TEST_CASE(csv_has_no_cell_that_a_spreadsheet_computes) {
  const auto written = [](const std::string& cell) {
    table t({"a"});
    t.add({cell});
    return t.csv();
  };
  for (const std::string cell :
       {"=1+1", "=cmd|x!A1", " =1", "\t@1", "@1", "+1.json", "-1+2", "-.5x", "=.5", "+inf+1", "--1"}) {
    BOOST_TEST(written(cell) == "a\n'" + cell + '\n');
  }
  for (const std::string number :
       {"-1", "+1", "-1e-3", "+.5", "-inf", "+nan", "-nan", "1e400", "-1e-400", "+"}) {
    BOOST_TEST(written(number) == "a\n" + number + '\n');  // a sign by itself is computed by none
  }
}

BOOST_AUTO_TEST_CASE(a_row_has_a_cell_for_each_column) {
  auto t = cells();
  for (const auto& row : {std::vector<std::string>{"one"}, std::vector<std::string>{"1", "2", "3"}, {}}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { t.add(row); },
                                              {std::to_string(row.size()) + " cells", "2 columns"}));
  }
  BOOST_TEST(t.csv() == cells().csv());
}

BOOST_AUTO_TEST_CASE(the_panel_has_a_curve_for_each_method) {
  auto rows = power_law();
  const auto plot = [&](const std::string& ours, auto cost) {
    return work_precision_panel(rows, ours, "cost", cost);
  };
  const auto by_evaluations = plot("b", &work_precision_row::evaluations_per_time);
  BOOST_REQUIRE(by_evaluations.curves.size() == 2);
  BOOST_TEST(by_evaluations.log_log);
  BOOST_TEST(by_evaluations.x_label == "cost");
  BOOST_TEST(by_evaluations.curves[0].label == "a");
  BOOST_TEST(!by_evaluations.curves[0].emphasised);
  BOOST_TEST(by_evaluations.curves[1].emphasised);
  BOOST_TEST((by_evaluations.curves[0].x == std::vector<double>{100, 400, 1600}));
  BOOST_TEST((by_evaluations.curves[1].y == std::vector<double>{99}));
  BOOST_TEST((by_evaluations.curves[1].error == std::vector<double>{9.9}));
  BOOST_TEST(plot("b", &work_precision_row::seconds_per_time).curves[1].x[0] == 1e-9 * 200);
  // What is learned is emphasised, and what does not count is hollow.
  rows[1].learned = true;
  rows[2].counts = false;  // the cheapest of method a
  const auto marked = plot("", &work_precision_row::evaluations_per_time);
  BOOST_TEST(!marked.curves[0].emphasised);
  BOOST_TEST(marked.curves[1].emphasised);
  BOOST_TEST((marked.curves[0].hollow == std::vector<bool>{true, false, false}));
  BOOST_TEST((marked.curves[1].hollow == std::vector<bool>{false}));
}

BOOST_AUTO_TEST_CASE(a_front_goes_from_cheap_to_dear) {
  const auto front = front_curve(power_law(), {3, 0, 2}, &work_precision_row::evaluations_per_time);
  BOOST_TEST(front.front);
  BOOST_TEST(front.x == (std::vector<double>{100, 400, 1600}), boost::test_tools::per_element());
  BOOST_TEST(front.y[2] == 7 * std::pow(1600, -2));
  BOOST_CHECK_THROW(front_curve(power_law(), {4}, &work_precision_row::evaluations_per_time),
                    std::out_of_range);
}
