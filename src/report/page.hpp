// SPDX-License-Identifier: BSL-1.0
// A report as a value: written once, read as Markdown and as a page of HTML.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "page_blocks.hpp"
#include "plot.hpp"
#include "table.hpp"

namespace nysalt {

/// Sentences (titles, paragraphs, items, captions) have `` `code` ``, `**bold**` and `[text](link)`, no more:
/// every other character means itself, also `<`. Cells of tables and commands have no markup at all.
///
///     page report("Speed against error");
///     report.text("Run with `nysalt compare`.");
///     report.picture(figure, "Error against cost.");
///     for (const figure& f : report.figures()) draw(f, folder);
///     write_file(folder / "report.html", report.html(folder));
class page {
 public:
  explicit page(std::string title);  ///< empty but for its title

  /// Begins a section.
  void heading(std::string text);
  /// Begins a part of a section.
  void subheading(std::string text);
  /// A paragraph: a sentence or several.
  void text(std::string paragraph);
  /// The same of what the page is for. On a page of HTML the first such stays in view.
  void verdict(std::string paragraph);
  /// A list with a dot before each item.
  void list(std::vector<std::string> items);
  /// A table; words of its cells are set as they are.
  void table(nysalt::table rows);
  /// A command or an output, as it is.
  void code(std::string text);
  /// Throws std::invalid_argument if the page has a picture of that name, as their files would be one, or if
  /// the name is none that draw() takes.
  void picture(figure drawing, std::string caption);

  /// GitHub's Markdown; a picture is `PICTURES/NAME.svg` with its caption, which is repeated below.
  std::string markdown(const std::string& pictures = "") const;
  /// One page by the template in share/report, that needs no other file, no script and no network: the
  /// pictures that draw() left in the folder are in it. Where one is missing a sentence says so.
  std::string html(const std::filesystem::path& pictures) const;
  /// The pictures, in the order of the page.
  const std::vector<figure>& figures() const { return figures_; }

 private:
  std::string title_;
  std::vector<page_block> blocks_;
  std::vector<figure> figures_;
};

}  // namespace nysalt
