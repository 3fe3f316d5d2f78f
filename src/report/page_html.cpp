// SPDX-License-Identifier: BSL-1.0
#include "page_html.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "escaped.hpp"
#include "page_script.hpp"
#include "plain_words.hpp"
#include "svg.hpp"

namespace nysalt {

namespace {

/// Nothing may be fetched, from wherever, and no script runs but that of the page.
std::string page_policy() {
  return fmt::format(
      "default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{}'; base-uri 'none'; "
      "form-action 'none'",
      page_script_sha256);
}

/// Quiet, of the system's own font; pictures shrink and wide tables scroll in themselves. On paper no picture
/// and no row breaks, a table that goes on has its head again, and there are no controls.
constexpr std::string_view page_style = R"(
body{font:16px/1.55 system-ui,sans-serif;color:#222;background:#fff}
body{max-width:68rem;margin:2rem auto;padding:0 1rem}
h1,h2,h3{line-height:1.25;margin:2rem 0 .6rem}
h1{font-size:1.8rem;margin-top:0}
h2{font-size:1.35rem;border-bottom:1px solid #ddd;padding-bottom:.2rem}
h3{font-size:1.1rem}
p,li,figcaption{max-width:46rem}
a{color:#0b5394}
nav{border-left:3px solid #ddd;padding-left:1rem}
nav ul{list-style:none;padding:0;margin:0}
code,pre{font:.9em ui-monospace,monospace;background:#f5f5f5}
code{padding:.1em .25em}
pre{padding:.7rem;overflow-x:auto}
pre code{padding:0}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}
th,td{padding:.2rem .7rem;text-align:left;border-bottom:1px solid #e5e5e5}
th{border-bottom:2px solid #bbb}
th.n,td.n{text-align:right}
td.n{white-space:nowrap}
td.long{white-space:normal;min-width:12rem}
th button{font:inherit;color:inherit;background:none;border:0;padding:0;cursor:pointer;text-align:inherit}
th button::after{content:"\2195";color:#999;padding-left:.25em}
th[aria-sort=ascending] button::after{content:"\2191";color:inherit}
th[aria-sort=descending] button::after{content:"\2193";color:inherit}
button:focus-visible,input:focus-visible{outline:2px solid #0b5394;outline-offset:2px}
.filter{margin:.6rem 0}
.filter input{font:inherit;padding:.1rem .4rem;border:1px solid #888;border-radius:3px;max-width:60vw}
.filter output{color:#555}
figure{margin:1.5rem 0}
figure svg{display:block;max-width:100%;height:auto}
figcaption{color:#444;font-size:.92rem}
figure svg *{pointer-events:none}
figure svg .point *{pointer-events:all}
.point:hover use{opacity:.25}
.value{position:fixed;max-width:90vw;background:#222;color:#fff;font-size:.85rem;padding:.2rem .5rem}
.value{border-radius:3px;pointer-events:none}
.missing{color:#777;font-style:italic}
@media print{
body{max-width:none;margin:0;padding:0;font-size:10pt}
figure,thead,tr,pre{break-inside:avoid}
pre{white-space:pre-wrap;overflow:visible}
nav,.value,.filter label{display:none}
th button::after{content:none}
thead{display:table-header-group}
table{font-size:7pt}
h1,h2,h3{break-after:avoid}
.scroll{overflow:visible}
th,td{padding:.15rem .3rem}
a{color:inherit}
}
)";

std::string html_sentence(std::string_view text) {
  std::string result;
  for (const styled_words& words : plain_words(text)) {
    const std::string inside = html_escaped(words.text);
    switch (words.is) {
      case styled_words::kind::plain:
        result += inside;
        break;
      case styled_words::kind::code:
        result += "<code>" + inside + "</code>";
        break;
      case styled_words::kind::bold:
        result += "<strong>" + inside + "</strong>";
        break;
      case styled_words::kind::link:
        result += fmt::format("<a href=\"{}\">{}</a>", html_escaped(words.address), inside);
    }
  }
  return result;
}

/// A sentence without its marks, for attributes and for the title of the window.
std::string html_plain(std::string_view text) {
  std::string result;
  for (const styled_words& words : plain_words(text)) result += html_escaped(words.text);
  return result;
}

struct html_of_block {
  const std::filesystem::path& pictures;
  int headings = 0;  // so far

  std::string operator()(const heading_block& heading) {
    return fmt::format("<h{0} id=\"section-{1}\">{2}</h{0}>\n", heading.level, ++headings,
                       html_sentence(heading.text));
  }
  std::string operator()(const text_block& paragraph) const {
    return fmt::format("<p>{}</p>\n", html_sentence(paragraph.text));
  }
  std::string operator()(const list_block& list) const {
    std::string result = "<ul>\n";
    for (const auto& item : list.items) result += fmt::format("<li>{}</li>\n", html_sentence(item));
    return result + "</ul>\n";
  }
  std::string operator()(const table_block& block) const {
    return fmt::format("<div class=\"scroll\">\n{}</div>\n", block.rows.html());
  }
  std::string operator()(const code_block& code) const {
    return fmt::format("<pre><code>{}</code></pre>\n", html_escaped(code.text));
  }
  std::string operator()(const picture_block& picture) const {
    std::string drawn = svg_element(pictures / (picture.name + ".svg"));
    if (drawn.empty()) {
      drawn = fmt::format(
          "<p class=\"missing\">The picture {} is missing, as gnuplot is not there or failed.</p>",
          picture.name);
    }
    return fmt::format(
        "<figure data-name=\"{}\">\n<div role=\"img\" "
        "aria-label=\"{}\">\n{}\n</div>\n<figcaption>{}</figcaption>\n</figure>\n",
        picture.name, html_plain(picture.caption), drawn, html_sentence(picture.caption));
  }
};

/// The contents of a page of more than three sections.
std::string html_contents(const std::vector<page_block>& blocks) {
  std::string items;
  int headings = 0;
  int sections = 0;
  for (const auto& block : blocks) {
    const auto* heading = std::get_if<heading_block>(&block);
    if (heading == nullptr) continue;
    ++headings;
    if (heading->level != 2) continue;
    ++sections;
    items += fmt::format("<li><a href=\"#section-{}\">{}</a></li>\n", headings, html_plain(heading->text));
  }
  return sections > 3 ? fmt::format("<nav aria-label=\"Contents\">\n<ul>\n{}</ul>\n</nav>\n", items) : "";
}

}  // namespace

std::string page_html(const std::string& title, const std::vector<page_block>& blocks,
                      const std::filesystem::path& pictures) {
  std::string result = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<h1>{}</h1>\n",
      page_policy(), html_plain(title), page_style, html_sentence(title));
  html_of_block write{pictures};
  for (const auto& block : blocks) {
    const bool begins_sections = std::holds_alternative<heading_block>(block) && write.headings == 0;
    if (begins_sections) result += html_contents(blocks);  // what is above comes first
    result += std::visit(write, block);
  }
  return result + fmt::format("<script>{}</script>\n</body>\n</html>\n", page_script);
}

}  // namespace nysalt
