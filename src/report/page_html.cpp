// SPDX-License-Identifier: BSL-1.0
#include "page_html.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "escaped.hpp"
#include "inline_svg.hpp"
#include "plain_words.hpp"

namespace nysalt {

namespace {

/// Quiet, of the system's own font; pictures shrink and wide tables scroll in themselves; on paper no
/// picture and no row breaks.
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
th,td{padding:.2rem .7rem;text-align:left;white-space:nowrap;border-bottom:1px solid #e5e5e5}
th{border-bottom:2px solid #bbb}
th.n,td.n{text-align:right}
figure{margin:1.5rem 0}
figure svg{display:block;max-width:100%;height:auto}
figcaption{color:#444;font-size:.92rem}
.missing{color:#777;font-style:italic}
@media print{
body{max-width:none;margin:0;font-size:11pt}
figure,tr{break-inside:avoid}
h1,h2,h3{break-after:avoid}
.scroll{overflow:visible}
th,td{white-space:normal}
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
    std::string drawn =
        inline_svg(pictures / (picture.name + ".svg"), picture.name, html_plain(picture.caption));
    if (drawn.empty()) {
      drawn = fmt::format(
          "<p class=\"missing\">The picture {0} is missing, as gnuplot is not there or failed: "
          "<code>{0}.gp</code> and <code>{0}.dat</code> draw it later.</p>",
          picture.name);
    }
    return fmt::format("<figure>\n{}\n<figcaption>{}</figcaption>\n</figure>\n", drawn,
                       html_sentence(picture.caption));
  }
};

/// The contents at the top of a page of more than three sections.
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
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<h1>{}</h1>\n",
      html_plain(title), page_style, html_sentence(title));
  result += html_contents(blocks);
  html_of_block write{pictures};
  for (const auto& block : blocks) result += std::visit(write, block);
  return result + "</body>\n</html>\n";
}

}  // namespace nysalt
