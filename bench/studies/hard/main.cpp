// SPDX-License-Identifier: BSL-1.0
// nysalt_hard FOLDER [CASE...]: every hard case in its long form, as a page with pictures.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>

#include "../../../src/report/page.hpp"
#include "hard_case.hpp"

namespace {

using namespace nysalt;
using namespace nysalt::hard;

struct finished_case {
  hard_case tested;
  verdict what_came_out;
};
struct finished_topic {
  std::string title;
  std::vector<finished_case> cases;
};

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// On a terminal says what is under way; in a pipe nothing.
void say_under_way(const std::string& text) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r\033[K{}", text);
  std::fflush(stderr);
}

std::vector<finished_topic> run_all(const std::vector<std::string>& wanted) {
  std::vector<finished_topic> all;
  for (const auto& topic : all_topics()) {
    all.push_back({topic.title, {}});
    for (const auto& one : topic.cases) {
      if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), one.name) == wanted.end()) continue;
      say_under_way(one.name);
      const auto begin = std::chrono::steady_clock::now();
      all.back().cases.push_back({one, one.run(extent::full)});
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
      const verdict& result = all.back().cases.back().what_came_out;
      say_under_way("");
      fmt::print("{:<10} {:<26} {:6.1f} s\n", result.holds() ? "holds" : "BROKEN", one.name, seconds.count());
      for (const auto& sentence : result.measured()) fmt::print("{:>11}{}\n", "", sentence);
      std::fflush(stdout);
    }
  }
  return all;
}

page page_of(const std::vector<finished_topic>& all) {
  page result("Hard cases");
  result.text(
      "Where integrators come to grief, what must hold there all the same, and what was measured. Each case "
      "is also a "
      "test, in a shorter form, and beside what must hold stands what the same judgement must reject. Made "
      "again by the "
      "command below.");
  result.code("./dev hard");
  result.text(fmt::format("{:%Y-%m-%d}, compiler {}.", fmt::gmtime(std::time(nullptr)), __VERSION__));
  table summary({"case", "what must hold", "holds"}, 3);
  for (const auto& topic : all) {
    for (const auto& [tested, out] : topic.cases)
      summary.add({in_words(tested.name), tested.must_hold, out.holds() ? "yes" : "NO"});
  }
  result.table(summary);
  for (const auto& topic : all) {
    if (topic.cases.empty()) continue;
    result.heading(topic.title);
    for (const auto& [tested, out] : topic.cases) {
      result.subheading(in_words(tested.name));
      result.text(tested.what);
      result.list({"**Must hold:** " + tested.must_hold, "**Must fail:** " + tested.must_fail});
      result.text(out.holds() ? "Measured:" : "Measured, and **not as it must be**:");
      result.list(out.measured());
      if (const auto& shown = out.picture()) {
        result.picture({.name = tested.name, .panels = shown->panels, .width = shown->width}, shown->caption);
      }
    }
  }
  return result;
}

void write(const page& report, const std::filesystem::path& folder) {
  const auto pictures = folder / "hard-cases";
  std::filesystem::create_directories(pictures);
  for (const auto& picture : report.figures()) {
    say_under_way("drawing " + picture.name);
    draw(picture, pictures);
  }
  say_under_way("");
  write_file(folder / "hard-cases.md", report.markdown("hard-cases"));
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.empty()) {
    fmt::print(stderr, "usage: nysalt_hard FOLDER [CASE...]\n");
    return 2;
  }
  try {
    const auto all = run_all({arguments.begin() + 1, arguments.end()});
    write(page_of(all), arguments.front());
    int broken = 0;
    for (const auto& topic : all) {
      for (const auto& one : topic.cases) broken += !one.what_came_out.holds();
    }
    fmt::print("Written: {}/hard-cases.md\n", arguments.front());
    if (broken > 0) fmt::print("{} cases do not hold\n", broken);
    return broken > 0 ? 1 : 0;
  } catch (const std::exception& problem) {
    say_under_way("");
    fmt::print(stderr, "nysalt_hard: {}\n", problem.what());
    return 1;
  }
}
