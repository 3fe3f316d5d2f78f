// SPDX-License-Identifier: BSL-1.0
// nysalt_error_bars FOLDER: whether error bars cover, as a table. Ends with 1 if one neither does nor is
// marked.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <thread>

#include "../../../src/report/write_file.hpp"
#include "coverage.hpp"

int main(int count, char** arguments) {
  using namespace nysalt;
  if (count != 2) {
    fmt::print(stderr, "usage: nysalt_error_bars FOLDER\n");
    return 2;
  }
  try {
    const std::filesystem::path folder(arguments[1]);
    std::filesystem::create_directories(folder);
    coverage::extent what;
    what.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    const auto all = coverage::covered_rows(what);
    write_file(folder / "table.md", coverage::page_of(all, what));
    write_file(folder / "table.csv", coverage::csv_of(all));
    const auto is_wrong = [](const coverage::row& line) { return !line.covers() && !line.has_tail(); };
    const auto wrong = std::ranges::count_if(all, is_wrong);
    fmt::print("{} rows, {} neither cover nor are marked; {}\n", all.size(), wrong,
               (folder / "table.md").string());
    return wrong == 0 ? 0 : 1;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "nysalt_error_bars: {}\n", problem.what());
    return 2;
  }
}
