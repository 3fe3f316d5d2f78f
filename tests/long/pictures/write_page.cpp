// SPDX-License-Identifier: BSL-1.0
// Pages for check_page.sh and check_controls.sh: write_page FOLDER writes one that is well, and some that
// must be found.
#include <cmath>
#include <filesystem>
#include <string>

#include "../../../src/report/page.hpp"

using namespace nysalt;

namespace {

figure errors() {
  panel plot{.title = "errors", .x_label = "cost", .y_label = "error", .log_log = true, .curves = {}};
  for (int j = 0; j < 8; ++j) {
    curve one{.label = "method " + std::to_string(j), .x = {}, .y = {}, .emphasised = j == 0};
    for (int i = 0; i < 6; ++i) {
      one.x.push_back((10.0 + j) * std::pow(2.0, i));
      one.y.push_back(std::pow(one.x.back(), -2.0));
      one.error.push_back(0.2 * one.y.back());
      one.hollow.push_back(i == 0);
    }
    plot.curves.push_back(one);
  }
  plot.levels = {{"null model", 0.05}};
  return {"errors", {plot}};
}

figure lines() {
  panel plot;
  plot.curves.push_back({"a", {0, 1, 2}, {1, 2, 1}});
  return {"lines", {plot}};
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  return text.replace(text.find(old), old.size(), by);
}

/// A mistake in the script of a page, without the policy: that allows the script without the mistake alone.
std::string planted(std::string page, const std::string& old, const std::string& by) {
  const std::size_t policy = page.find("<meta http-equiv=\"Content-Security-Policy\"");
  page.erase(policy, page.find('>', policy) + 1 - policy);
  return replaced(page, old, by);
}

}  // namespace

int main(int, char** arguments) {
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  page report("Pictures");
  report.heading("All");
  report.picture(errors(), "Error against cost, of `<b>&\"'`.");
  report.picture(lines(), "A line.");
  for (const auto& picture : report.figures()) draw(picture, folder);
  table small({"method", "error"});
  for (int i = 0; i < 3; ++i) small.add({"m" + std::to_string(i), "1e-" + std::to_string(i)});
  report.table(small);
  table large({"method", "step", "error", "marks"});
  for (int i = 0; i < 12; ++i) {
    large.add({std::vector<std::string>{"verlet", "learned:fg4", "bcss3"}[static_cast<std::size_t>(i % 3)],
               std::to_string(0.01 * (i * 7 % 12)),
               i == 5 ? "-" : std::to_string(i * 5 % 12 - 4) + "e-" + std::to_string(i % 4),
               i == 3 ? "tail" : ""});
  }
  report.table(large);
  const std::string well = report.html(folder);
  write_file(folder / "well.html", well);
  const std::size_t last = well.rfind("base64,");
  write_file(folder / "broken.html",
             well.substr(0, last) + "base64,AAAA" + well.substr(well.find('"', last)));
  write_file(folder / "asking.html", replaced(well, "</h1>", "</h1><img src=\"http://127.0.0.1:9/x.png\">"));
  write_file(folder / "no_script.html", well.substr(0, well.find("<script>")));
  write_file(folder / "unsorted.html", planted(well, "way * compared(a, b)", "compared(a, b)"));
  write_file(folder / "wrong_filter.html", planted(well, "!words.every(", "words.every("));
  write_file(folder / "heavy.html", well + std::string(2'000'000, ' '));
  std::filesystem::remove(folder / "lines.svg");
  write_file(folder / "missing.html", report.html(folder));
}
