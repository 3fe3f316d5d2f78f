// SPDX-License-Identifier: BSL-1.0
// nysalt_scaling_report FOLDER: from the folder's *.jsonl, which nysalt_scaling printed, the tables on
// stdout, and table.md, rows.csv and the picture into the folder.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "../../../src/report/plot.hpp"
#include "../../../src/report/write_file.hpp"
#include "../../processor.hpp"
#include "jobs.hpp"
#include "picture.hpp"
#include "tables.hpp"

namespace {

using namespace nysalt::bench;

/// All that there is to read; `form` makes text of a table.
std::string pages(const measured& all, const fitted& model, const cluster& where, auto form) {
  const foretold on(model, where);
  std::string text = fmt::format("{}, {} cores\n", processor(), all.reductions.at(0).cores);
  const auto add = [&](const std::string& title, const nysalt::table& rows) {
    text += fmt::format("\n{}\n\n{}", title, form(rows));
  };
  add("Two ranks (? where the machine is too busy to say; then its bare kernel gains less than 1.9, too):",
      acceptance(all));
  add("More ranks, for the same work (strong) and for as much a rank (weak); the model knows a single rank:",
      efficiencies(all, model));
  add("The model's costs, and their standard errors:", costs(model));
  add("The work of one rank that they were fitted to, beside the strong one above:", sizes(all, model));
  add("One sum over all ranks. With fewer cores than ranks it waits for cores, and is not fitted:",
      reductions(all, model));
  add("Peak memory of a rank that learns, data and held-out data of as many trajectories each:",
      memory(all, model));
  text += "\n## Foretold\n";
  add("Assumed of a cluster:", assumptions(where));
  add("(a)", learning_job(on, where));
  add("(b)", langevin_job(on, where));
  add("(c)", gathering_job(all, where));
  add("Too many ranks for a pass:", too_many(on));
  return text;
}

void report(const std::filesystem::path& folder) {
  const measured all = read_measured(folder);
  const fitted model = fit_model(all);
  const cluster where;
  nysalt::write_file(folder / "rows.csv", rows_of(all).csv());
  const auto as_markdown = [](const nysalt::table& t) { return t.markdown(); };
  nysalt::write_file(folder / "table.md", "# How it scales\n\n" + pages(all, model, where, as_markdown));
  fmt::print("{}", pages(all, model, where, [](const nysalt::table& t) { return t.text(); }));
  if (!nysalt::draw(picture(all, model, foretold(model, where)), folder)) {
    fmt::print("no picture: gnuplot is not there or failed\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: nysalt_scaling_report FOLDER\n");
    return 2;
  }
  try {
    report(argv[1]);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "nysalt_scaling_report: {}\n", problem.what());
    return 1;
  }
}
