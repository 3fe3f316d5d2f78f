// SPDX-License-Identifier: BSL-1.0
// nysalt_sampling FOLDER [--quick] [CHAPTER...]: words for Hybrid Monte Carlo on targets of which others
// published numbers, as a page with its data and pictures.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../../../src/report/machine.hpp"
#include "../../../src/report/plot.hpp"
#include "../../../src/report/write_file.hpp"
#include "chapters.hpp"

namespace {

using namespace nysalt;
using namespace nysalt::sampling_benchmark;

const std::vector<std::pair<std::string, void (*)(const extent&, page&, table&)>> chapters{
    {"gaussians", add_gaussians}, {"lattice", add_lattice}, {"posterior", add_posterior}};

void write(const page& report, const table& rows, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "sampling");
  for (const auto& picture : report.figures()) draw(picture, folder / "sampling");
  write_file(folder / "sampling.md", report.markdown("sampling"));
  write_file(folder / "sampling" / "rows.csv", rows.csv());
}

void run(const std::filesystem::path& folder, bool quick, const std::vector<std::string>& wanted) {
  const auto began = std::chrono::steady_clock::now();
  page report("Sampling");
  report.text(
      "Words for Hybrid Monte Carlo at equal trajectories: the step per gradient at an acceptance of 0.9, "
      "and "
      "gradients of a chain until the error of its mean is low for good, the median of four chains; ± is the "
      "standard error by resampling the chains. Durations are uniform between zero and twice the mean "
      "length, "
      "which is one for all words of a table, and a trajectory has one step at least. Where the step at an "
      "acceptance of 0.9 is longer than the mean length, a word takes that length as its step if this costs "
      "less. Burn-in and tuning are not counted, nor is the gradient at the start of a trajectory, which the "
      "one "
      "before has computed; both as in the published numbers (`sampler-benchmarks` by R. Cohn-Gordon and J. "
      "Robnik, commit 7ad0700: adjusted Hamiltonian Monte Carlo at the same acceptance, its trajectory "
      "lengths "
      "tuned for each word apart).");
  report.code("./dev sampling");
  table rows = all_rows();
  const extent how{.quick = quick,
                   .threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency())),
                   .save = [&] { write(report, rows, folder); }};
  for (const auto& [name, add] : chapters) {
    if (!wanted.empty() && std::ranges::find(wanted, name) == wanted.end()) continue;
    add(how, report, rows);
    how.save();
  }
  const std::chrono::duration<double, std::ratio<60>> minutes = std::chrono::steady_clock::now() - began;
  report.text(
      fmt::format("{:%Y-%m-%d}, compiler {}, {} threads, {:.0f} minutes{}. [All rows](sampling/rows.csv).",
                  fmt::gmtime(std::time(nullptr)), __VERSION__, how.threads, minutes.count(),
                  quick ? ", in the short form: numbers to be looked at for their order alone" : ""));
  how.save();
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool quick = std::erase(arguments, "--quick") > 0;
  const auto is_chapter = [](const std::string& text) {
    return std::ranges::any_of(chapters, [&](const auto& one) { return one.first == text; });
  };
  if (arguments.empty() || !std::all_of(arguments.begin() + 1, arguments.end(), is_chapter)) {
    fmt::print(stderr, "usage: nysalt_sampling FOLDER [--quick] [gaussians] [lattice] [posterior]\n");
    return 2;
  }
  try {
    run(arguments.front(), quick, {arguments.begin() + 1, arguments.end()});
    fmt::print("Written: {}/sampling.md\n", arguments.front());
    return 0;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "nysalt_sampling: {}\n", problem.what());
    return 1;
  }
}
