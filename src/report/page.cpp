// SPDX-License-Identifier: BSL-1.0
#include "page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "page_html.hpp"
#include "page_markdown.hpp"

namespace nysalt {

page::page(std::string title) : title_(std::move(title)) {}

void page::heading(std::string text) { blocks_.push_back(heading_block{2, std::move(text)}); }

void page::subheading(std::string text) { blocks_.push_back(heading_block{3, std::move(text)}); }

void page::text(std::string paragraph) { blocks_.push_back(text_block{std::move(paragraph)}); }

void page::verdict(std::string paragraph) { blocks_.push_back(text_block{std::move(paragraph), true}); }

void page::list(std::vector<std::string> items) { blocks_.push_back(list_block{std::move(items)}); }

void page::table(nysalt::table rows) { blocks_.push_back(table_block{std::move(rows)}); }

void page::code(std::string text) { blocks_.push_back(code_block{std::move(text)}); }

void page::picture(figure drawing, std::string caption) {
  detail::require_plain(drawing.name);
  if (std::ranges::find(figures_, drawing.name, &figure::name) != figures_.end()) {
    throw std::invalid_argument(fmt::format(
        "page: pictures must have different names, got {} twice; give each a name of its own", drawing.name));
  }
  blocks_.push_back(picture_block{drawing.name, std::move(caption)});
  figures_.push_back(std::move(drawing));
}

std::string page::markdown(const std::string& pictures) const {
  return page_markdown(title_, blocks_, pictures);
}

std::string page::html(const std::filesystem::path& pictures) const {
  return page_html(title_, blocks_, pictures);
}

}  // namespace nysalt
