// SPDX-License-Identifier: BSL-1.0
#include "page_html.hpp"

#include <array>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <kainjow/mustache.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "page_files.hpp"
#include "plain_words.hpp"
#include "table.hpp"

namespace nysalt {

namespace {

using kainjow::mustache::data;

/// A name and what it stands for, for the template.
data named(const char* name, const data& value) { return {name, value}; }

data words_of(std::string_view sentence) {
  data list(data::type::list);
  for (const styled_words& words : plain_words(sentence)) {
    constexpr std::array kinds{"plain", "code", "bold", "link"};
    data one("text", words.text);
    one.set("address", words.address);
    list << named(kinds[static_cast<std::size_t>(words.is)], one);
  }
  return list;
}

/// The sentence without its marks, for attributes and for the title of the window.
std::string plain_of(std::string_view sentence) {
  std::string result;
  for (const styled_words& words : plain_words(sentence)) result += words.text;
  return result;
}

data sentence_of(std::string_view text) {
  data result("sentence", words_of(text));
  result.set("plain", plain_of(text));
  return result;
}

/// The SVG file as an address of itself, so that pictures share no names of their parts; false if there is
/// none that is whole.
data source_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t from = text.find("<svg");
  if (from == std::string::npos || text.find("</svg>", from) == std::string::npos) return false;
  using namespace boost::archive::iterators;
  using base64 = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
  std::string code(base64(text.begin()), base64(text.end()));
  code.append((4 - code.size() % 4) % 4, '=');
  return "data:image/svg+xml;base64," + code;
}

data cells_of(const std::vector<std::string>& texts, const std::vector<std::string>& columns,
              std::size_t left) {
  constexpr std::size_t on_a_line = 30;  // bytes: what is longer is a list
  data result(data::type::list);
  for (std::size_t j = 0; j < texts.size(); ++j) {
    data cell("text", texts[j]);
    cell.set("column", columns[j]);
    cell.set("kind", texts[j].size() > on_a_line ? "long" : j < left ? "" : "number");
    result << cell;
  }
  return result;
}

/// Blocks as the template reads them.
struct data_of_block {
  const std::filesystem::path& pictures;
  int headings = 0;  // so far

  data operator()(const heading_block& heading) {
    data result = sentence_of(heading.text);
    result.set("level", std::to_string(heading.level));
    result.set("number", std::to_string(++headings));
    return named("heading", result);
  }
  data operator()(const text_block& paragraph) const {
    return named(paragraph.is_verdict ? "verdict" : "text", sentence_of(paragraph.text));
  }
  data operator()(const list_block& list) const {
    data items(data::type::list);
    for (const auto& item : list.items) items << sentence_of(item);
    return named("list", named("items", items));
  }
  data operator()(const table_block& block) const {
    const auto& columns = block.rows.columns();
    data rows(data::type::list);
    for (const auto& row : block.rows.rows())
      rows << named("cells", cells_of(row, columns, block.rows.left()));
    data result("rows", rows);
    result.set("columns", cells_of(columns, columns, block.rows.left()));
    return named("table", result);
  }
  data operator()(const code_block& code) const { return named("code", named("text", code.text)); }
  data operator()(const picture_block& picture) const {
    data result = sentence_of(picture.caption);
    result.set("name", picture.name);
    result.set("source", source_of(pictures / (picture.name + ".svg")));
    return named("picture", result);
  }
};

/// The sections of a page of more than three; else false.
data contents_of(const std::vector<page_block>& blocks) {
  data sections(data::type::list);
  int headings = 0;
  int count = 0;
  for (const auto& block : blocks) {
    const auto* heading = std::get_if<heading_block>(&block);
    if (heading == nullptr) continue;
    ++headings;
    if (heading->level != 2) continue;
    ++count;
    data one("number", std::to_string(headings));
    one.set("plain", plain_of(heading->text));
    sections << one;
  }
  return count > 3 ? named("sections", sections) : data(false);
}

}  // namespace

std::string page_html(const std::string& title, const std::vector<page_block>& blocks,
                      const std::filesystem::path& pictures) {
  data list(data::type::list);
  data_of_block write{pictures};
  for (const auto& block : blocks) {
    if (std::holds_alternative<heading_block>(block) && write.headings == 0)
      list << named("contents", contents_of(blocks));  // what is above the sections comes first
    list << std::visit(write, block);
  }
  data page("title", words_of(title));
  page.set("plain_title", plain_of(title));
  page.set("style", std::string(page_files::style));
  page.set("script", std::string(page_files::script));
  page.set("script_sha256", std::string(page_files::script_sha256));
  page.set("words", data(kainjow::mustache::partial([] { return std::string(page_files::words); })));
  page.set("blocks", list);
  return kainjow::mustache::mustache(std::string(page_files::page)).render(page);
}

}  // namespace nysalt
