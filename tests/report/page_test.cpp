// SPDX-License-Identifier: BSL-1.0
// A page says what it was told, in Markdown and in HTML, and needs nothing but itself.
#include <boost/test/unit_test.hpp>

#include <cstdlib>
#include <regex>
#include <set>
#include <string>

#include "../../src/report/page.hpp"
#include "../../src/report/svg.hpp"
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
<use xlink:href='#dot'/><path clip-path="url(#clip)"/><text> #dot</text></g>
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

}  // namespace

BOOST_AUTO_TEST_CASE(markdown_is_as_expected) {
  BOOST_TEST(example().markdown("pictures") ==
             "# Speed, `x_1` \\<now\\>\n"
             "\n## One\n"
             "\nSee **this** and [that](a/b.md): 2 \\* 3 \\< `a*b`.\n"
             "\n- first\n- second\n"
             "\n| method | error |\n| ------ | ----- |\n| a\\|b   |  1e-3 |\n"
             "\n### Two\n"
             "\n```\nnysalt compare\n```\n"
             "\n![A \\[picture\\].](pictures/p.svg)\n\nA \\[picture\\].\n");
  BOOST_TEST(has(example().markdown(), "](p.svg)"));
}

BOOST_AUTO_TEST_CASE(code_with_backquotes_has_a_longer_fence) {
  page report("t");
  report.code("```\n");
  BOOST_TEST(has(report.markdown(), "\n````\n```\n````\n"));
}

BOOST_AUTO_TEST_CASE(html_says_the_same) {
  const scratch folder("page");
  write_file(folder / "p.svg", svg);
  const auto html = example().html(folder.path());
  for (const char* words :
       {"<!DOCTYPE html>", "<title>Speed, x_1 &lt;now&gt;</title>",
        "<h1>Speed, <code>x_1</code> &lt;now&gt;</h1>",
        "<p>See <strong>this</strong> and <a href=\"a/b.md\">that</a>: 2 * 3 &lt; <code>a*b</code>.</p>",
        "<li>first</li>\n<li>second</li>", "<th class=\"n\">error</th>",
        "<td>a|b</td><td class=\"n\">1e-3</td>", "<pre><code>nysalt compare</code></pre>",
        "<div role=\"img\" aria-label=\"A [picture].\">\n<svg", "<figcaption>A [picture].</figcaption>"}) {
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
  report.list({nasty});
  nysalt::table cells({nasty, nasty});
  cells.add({nasty, nasty});
  report.table(cells);
  report.code(nasty);
  report.picture(named("p"), nasty);
  const auto html = report.html(folder.path());
  BOOST_TEST(!has(html, "<b>"));
  BOOST_TEST(!has(html, "&\""));
  BOOST_TEST(has(html, "aria-label=\"&lt;b&gt;&amp;&quot;&#39;\""));
  BOOST_TEST(has(html, "href=\"x?&quot;&#39;&amp;&lt;\""));
}

BOOST_AUTO_TEST_CASE(a_link_that_would_run_something_is_no_link) {
  page report("t");
  report.text("[a](javascript:alert(1)) and [b](https://example.org/c) and [open](");
  const auto html = report.html(".");
  BOOST_TEST((matches(html, "href=\"([^\"]*)\"") == std::multiset<std::string>{"https://example.org/c"}));
  BOOST_TEST(has(html, "[a](javascript:"));
}

BOOST_AUTO_TEST_CASE(pictures_have_ids_of_their_own_and_nothing_dangles) {
  const scratch folder("page");
  page report("t");
  for (const char* name : {"p", "q"}) {
    write_file(folder / (std::string(name) + ".svg"), finished_svg(svg, named(name)));
    report.picture(named(name), "c");
  }
  BOOST_TEST(report.figures().size() == 2U);
  const auto html = report.html(folder.path());
  const auto ids = matches(html, " id=[\"']([^\"']*)[\"']");
  BOOST_TEST((ids == std::multiset<std::string>{"p-clip", "p-dot", "q-clip", "q-dot"}));
  BOOST_TEST((matches(html, "(?:url\\(|href=')#([^)']*)") == ids));
  for (const char* words : {"<?xml", "DTD", "Gnuplot", "plot_1", "fill=\"none\""}) {
    BOOST_TEST(!has(html, words), "still there: " << words);
  }
  BOOST_TEST(has(html, "<text> #dot</text>"));  // what is seen stays
}

// gnuplot writes up to 2000 points as one tag; libstdc++'s std::regex takes stack for each character of a
// match.
BOOST_AUTO_TEST_CASE(a_curve_of_many_points_is_one_long_tag) {
  for (const int points : {2, 5000, 500'000}) {
    std::string path = "<path stroke='black' d='M";
    for (int i = 0; i < points; ++i) path += std::to_string(i) + ".25," + std::to_string(i % 480) + ".5 L";
    path += "'/>";
    const std::string drawn = "<svg><g id=\"gnuplot_plot_1\" ><title>Gnuplot</title>\n" + path +
                              "</g>\n<g fill=\"none\">\n</g>\n<circle id='dot'/></svg>";
    BOOST_TEST(
        (finished_svg(drawn, named("p")) == "<svg><g >" + path + "</g>\n\n<circle id='p-dot'/></svg>"));
  }
}

// Broken pictures are no pictures, but nothing else breaks.
BOOST_AUTO_TEST_CASE(tags_without_end_are_kept) {
  for (const char* text : {"", "<", ">", "<svg", "<title>", "<title>a", "<title></title>", "</g>", "<g ></g",
                           "<g onmousemove=\"showHypertext(evt,'x.1')\">"}) {
    const std::string expected = std::string(text) == "<title></title>" ? "" : text;
    BOOST_TEST(finished_svg(text, named("p")) == expected);
  }
}

BOOST_AUTO_TEST_CASE(no_address_of_anything_outside_is_in_a_page) {
  const scratch folder("page");
  page report("t");
  panel one;
  one.curves.push_back({nasty, {0, 1}, {0, 1}});
  report.picture({"p", {one, one}}, "c");
  const bool drawn = draw(report.figures()[0], folder.path());
  const auto html = report.html(folder.path());
  BOOST_TEST(has(html, "<svg") == drawn);
  const auto outside = matches(html, "([a-z:]*=?\"?https?:)");
  BOOST_TEST((outside == (drawn ? std::multiset<std::string>{"xmlns:xlink=\"http:", "xmlns=\"http:"}
                                : std::multiset<std::string>{})));
  BOOST_TEST(!has(html, "<b>"));
  const auto ids = matches(html, " id=[\"']([^\"']*)[\"']");
  BOOST_TEST((ids.size() == std::set<std::string>(ids.begin(), ids.end()).size()));
  BOOST_TEST(has(html, "Content-Security-Policy\" content=\"default-src 'none';"));
  BOOST_TEST(!has(html, "src="));
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

BOOST_AUTO_TEST_CASE(what_is_above_the_sections_is_above_the_list_of_contents) {
  page report("t");
  report.text("The verdict.");
  for (const char* name : {"a", "b", "c", "d"}) report.heading(name);
  const auto html = report.html(".");
  BOOST_TEST(html.find("The verdict.") < html.find("<nav"));
  BOOST_TEST(html.find("<nav") < html.find("<h2"));
}

BOOST_AUTO_TEST_CASE(more_than_three_sections_have_a_list_of_contents) {
  page report("t");
  for (const char* name : {"a", "b", "c"}) report.heading(name);
  report.subheading("below");
  BOOST_TEST(!has(report.html("."), "<nav"));
  report.heading("`d`");
  const auto html = report.html(".");
  BOOST_TEST(has(html, "<a href=\"#section-5\">d</a>"));
  BOOST_TEST(has(html, "<h2 id=\"section-5\"><code>d</code></h2>"));
  BOOST_TEST(!has(html, "#section-4"));
}

BOOST_AUTO_TEST_CASE(two_pictures_of_one_name_are_refused) {
  auto report = example();
  BOOST_TEST(refuses<std::invalid_argument>([&] { report.picture(named("p"), "c"); },
                                            {"pictures must have different names", "got p twice"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { report.picture(named("../p"), "c"); }, {"letters"}));
  BOOST_TEST(report.figures().size() == 1U);
}
