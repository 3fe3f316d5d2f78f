// SPDX-License-Identifier: BSL-1.0
// The report of a comparison: a page with its pictures, and the tables for machines.
#include <fmt/chrono.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "build_info.hpp"
#include "comparison/catalogue.hpp"
#include "comparison_pictures.hpp"
#include "comparison_report.hpp"
#include "comparison_tables.hpp"
#include "machine.hpp"
#include "nysalt/learning/fit_summary.hpp"
#include "page.hpp"
#include "result_file.hpp"

namespace nysalt::program {

namespace {

void add_question(page& report, const comparison& all) {
  const comparison_options& options = all.options();
  report.text(fmt::format("{} trajectories of {}, each over {:g}; starts: {}; seed {}.", options.trajectories,
                          all.system().description(), all.horizon(), all.system().starts(),
                          all.common().seed));
  if (options.equal_cost) {
    report.text(
        "Steps are per force evaluation: a method of n evaluations takes n times the step, so equal "
        "steps are equal cost.");
  }
  if (!options.prices.empty()) report.text(sentence_of_prices(options.prices));
  if (!all.common().command.empty()) report.code(all.common().command);
}

std::string with_capital(std::string title) {
  title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
  return title;
}

/// A cost, or between which rows or beyond which it lies.
std::string text_of(const threshold_crossing& crossing, double unit) {
  const auto number = [&](double x) { return fmt::format("{:.4g}", x * unit); };
  switch (crossing.kind) {
    case threshold_crossing::crossing_kind::found:
      return with_error({crossing.x * unit, crossing.standard_error * unit});
    case threshold_crossing::crossing_kind::bracketed:
      return fmt::format("{} to {}", number(crossing.first_above), number(crossing.last_below));
    case threshold_crossing::crossing_kind::below_all:
      return fmt::format("below {}", number(crossing.x));
    case threshold_crossing::crossing_kind::above_from_first:
      return fmt::format("above {}", number(crossing.x));
  }
  return {};
}

/// The factor by which the cheapest classical method is more expensive: nothing is known where it is above
/// all its rows, and only a bound where its rows stay below, or lose the level between two.
std::string against_classical(const cost_at_level& cost, const std::vector<cost_at_level>& all) {
  const auto best = std::ranges::find_if(all, [](const cost_at_level& other) {
    return !other.is_learned && other.evaluations.kind != threshold_crossing::crossing_kind::above_from_first;
  });
  if (best == all.end() || cost.evaluations.kind != threshold_crossing::crossing_kind::found) return "-";
  const double ratio = best->evaluations.x / cost.evaluations.x;
  return fmt::format("{}{:.2f}",
                     best->evaluations.kind == threshold_crossing::crossing_kind::found ? "" : "< ", ratio);
}

/// After how much time of one trajectory the evaluations of learning are saved, against the cheapest
/// classical method at the same error; the most expensive fit of the method counts.
std::string repaid_after(const comparison& all, const cost_at_level& cost,
                         const std::vector<cost_at_level>& costs) {
  const auto best = std::ranges::find_if(costs, [](const cost_at_level& other) {
    return !other.is_learned && other.evaluations.kind == threshold_crossing::crossing_kind::found;
  });
  double spent = 0.0;
  for (const auto& fit : all.fits()) {
    if (fit.method == cost.method) spent = std::max(spent, fit.learning_evaluations);
  }
  if (best == costs.end() || spent == 0.0 ||
      cost.evaluations.kind != threshold_crossing::crossing_kind::found)
    return "-";
  const double saved = best->evaluations.x - cost.evaluations.x;
  return saved > 0.0 ? fmt::format("{:.2g}", spent / saved) : "never";
}

/// Costs to reach a level.
table level_table(const comparison& all, std::size_t m, double level) {
  const auto costs = costs_at(all, m, level);
  const bool is_learned = std::ranges::any_of(costs, &cost_at_level::is_learned);
  std::vector<std::string> names{"method", "evaluations/time", "ns/time", "cheapest classical / its"};
  if (is_learned) names.push_back("learning repaid after");
  table result(names);
  for (const cost_at_level& cost : costs) {
    std::vector<std::string> cells{cost.method, text_of(cost.evaluations, 1.0), text_of(cost.seconds, 1e9),
                                   against_classical(cost, costs)};
    if (is_learned) cells.push_back(repaid_after(all, cost, costs));
    result.add(cells);
  }
  return result;
}

/// Methods without any ranked row, and why.
std::string left_out(const comparison& all, std::size_t m) {
  std::string text;
  for (const auto& method : all.options().methods) {
    const auto is_of_it = [&](const row& line) { return line.method == method; };
    const auto is_ranked_row = [&](const row& line) { return is_of_it(line) && is_ranked(all, m, line); };
    const auto first = std::ranges::find_if(all.rows(), is_of_it);
    if (first == all.rows().end() || std::ranges::any_of(all.rows(), is_ranked_row)) continue;
    const std::string marks = joined_marks(all, m, *first);
    text += fmt::format("{}`{}` ({})", text.empty() ? "" : ", ", method, marks.empty() ? "no value" : marks);
  }
  return text.empty() ? text : fmt::format(" Not ranked at any step: {}.", text);
}

/// The verdict of each metric in a sentence.
void add_verdict(page& report, const comparison& all) {
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    // What stays in view is short.
    const std::string sentence = verdict_by_evaluations(all, m);
    const std::string both = verdict_of_both(best_by(all, m, evaluations_of), best_by(all, m, seconds_of),
                                             errors_compared(all, m));
    report.verdict(all.metrics().size() == 1 ? sentence
                                             : fmt::format("**{}**: {}", quantity(all, m), sentence));
    const std::string further = both.substr(sentence.size()) + left_out(all, m);
    if (!further.empty()) report.text(further.substr(1));
  }
}

void add_ranking(page& report, const comparison& all, std::size_t m) {
  report.table(ranking_of(all, m));
  const bool is_ranked_at_all =
      std::ranges::any_of(all.rows(), [&](const row& line) { return is_ranked(all, m, line); });
  if (!is_ranked_at_all) {
    report.text(
        "**No row is ranked**: none has a value of all trajectories within the time for which paths are "
        "predictable. Compare distributions (`distribution`, `acf`), or take a shorter horizon.");
    return;
  }
  if (table beside = equal_cost_table(all, m); !beside.empty()) {
    report.subheading("What is learned, beside the best of the others that cost no more");
    report.table(std::move(beside));
  }
  for (const double level : levels_for(all, m)) {
    if (all.metrics()[m].is_acceptance()) break;
    report.subheading(fmt::format("The cost of an error of {:g}", level));
    if (is_by_median(all, m)) report.text("Of the median over trajectories.");
    report.table(level_table(all, m, level));
  }
}

void add_metric(page& report, const comparison& all, std::size_t m) {
  report.heading(with_capital(quantity(all, m)));
  for (auto& picture : pictures_of_errors(all, m)) {
    const std::string caption = (is_by_median(all, m) ? "median " : "") + quantity(all, m) + " against " +
                                picture.panels.front().x_label + "; bars are standard errors";
    report.picture(std::move(picture), caption);
  }
  if (const auto drawn = drawn_methods(all, m).size(); drawn < all.options().methods.size()) {
    report.text(fmt::format("{} of {} methods are drawn: the cheapest of both kinds.", drawn,
                            all.options().methods.size()));
  }
  for (auto& picture : pictures_of_laws(all, m)) {
    const std::string caption = quantity(all, m) + ", " + picture.panels.front().title;
    report.picture(std::move(picture), caption);
  }
  add_ranking(report, all, m);
}

/// Every row, and what it is seen against.
void add_rows(page& report, const comparison& all) {
  report.heading("All rows");
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    report.subheading(with_capital(quantity(all, m)));
    report.table(rows_of(all, m));
    std::vector<std::string> sentences = meanings_of_marks(all, m);
    for (const auto& text : reasons_of(all, m)) sentences.push_back(text);
    if (!sentences.empty()) report.list(sentences);
    if (table against = baselines_of(all, m); !against.empty()) {
      report.subheading("What they are seen against");
      report.table(std::move(against));
    }
  }
}

void add_energies(page& report, const comparison& all) {
  auto pictures = pictures_of_energies(all);
  if (pictures.empty()) return;
  report.heading("Energy and survivors along time");
  for (auto& picture : pictures) {
    const panel& shown = picture.panels.front();
    const std::string what =
        shown.log_log ? "root mean square of H(t) - H(0) over the trajectories that survive" : shown.y_label;
    const std::string caption = shown.title + ": " + what;
    report.picture(std::move(picture), caption);
  }
}

/// "usable", "not usable", or "nothing gained over chin4a".
std::string verdict_of(const learned_row& fit) {
  return fit.verdict + (fit.gains_nothing() && !fit.rival.empty() ? " over " + fit.rival : "");
}

void add_fits(page& report, const comparison& all) {
  if (all.fits().empty()) return;
  report.heading("What was learned");
  table fits({"method", "step size", "parameters", "held-out error of a step", "evaluations", "seconds",
              "verdict", "scheme"});
  for (const auto& fit : all.fits()) {
    std::string parameters;
    for (const auto& [name, value] : fit.parameters) {
      parameters += fmt::format("{}{} = {:.6g}", parameters.empty() ? "" : ", ", name, value);
    }
    const auto number = [](double x) {
      return std::isfinite(x) ? fmt::format("{:.3g}", x) : std::string("-");
    };
    fits.add({fit.method, number(fit.step), parameters, number(fit.one_step_error),
              number(fit.learning_evaluations), number(fit.seconds), verdict_of(fit),
              fit.usable ? fmt::format("{}/{}", folder_of_schemes, scheme_file(fit.method, fit.step)) : "-"});
  }
  report.table(std::move(fits));
}

/// "b1 = 0.41, a = 0.2"; beyond the steps of the scheme the parameters of the nearer end.
std::string theta_of(const scheme& learned, double step) {
  const auto names = family_named(learned.family, learned.own_letters).parameter_names;
  const auto& steps = learned.curve.steps();
  const Eigen::VectorXd theta = learned.curve.at(std::clamp(step, steps.front(), steps.back()));
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    text +=
        fmt::format("{}{} = {:.6g}", text.empty() ? "" : ", ", names[k], theta[static_cast<Eigen::Index>(k)]);
  }
  return text;
}

/// Parameters and coefficients of the learned rows that were not learned here.
void add_files(page& report, const comparison& all) {
  table files({"method from a file", "step size", "parameters", "letters", "coefficients"});
  for (const row& line : all.rows()) {
    const bool is_fitted =
        std::ranges::any_of(all.fits(), [&](const learned_row& fit) { return fit.method == line.method; });
    if (!line.is_learned || is_fitted || !line.coefficients) continue;
    std::string numbers;
    for (const double c : line.coefficients->coefficients()) {
      numbers += fmt::format("{}{:.6g}", numbers.empty() ? "" : ", ", c);
    }
    const auto source = std::ranges::find_if(
        all.schemes(), [&](const method_source& one) { return one.typed == line.method; });
    files.add({line.method, fmt::format("{:.3g}", line.step), theta_of(*source->learned, line.step),
               line.coefficients->letters().letters(), numbers});
  }
  if (files.empty()) return;
  report.heading("What came from files");
  report.table(std::move(files));
}

page report_of(const comparison& all) {
  page report("Speed against error: " + all.system().description());
  add_verdict(report, all);
  add_question(report, all);
  for (std::size_t m = 0; m < all.metrics().size(); ++m) add_metric(report, all, m);
  add_energies(report, all);
  add_rows(report, all);
  add_fits(report, all);
  add_files(report, all);
  report.heading("How it was measured");
  std::vector<std::string> notes{
      // NOLINTNEXTLINE(bugprone-suspicious-missing-comma)
      "evaluations are force evaluations of one trajectory per unit time, counted while running, the first "
      "one included",
      "ns/time: nanoseconds per unit time of one trajectory of a large ensemble on one thread, the least of "
      "interleaved rounds; `median +` says how much more the median of the rounds is; an error of a cost in "
      "seconds is that of the errors without that of the times",
      "standard errors are over trajectories, which all methods share; those of distributions over groups of "
      "trajectories; those of gains are of the differences trajectory by trajectory",
      fmt::format(
          "errors along paths are means over [0, {:g}], the same for all rows; of paths, exchange and "
          "energies relative to a mean over all trajectories",
          all.horizon()),
      "learning repaid after: the time of one trajectory in which as many evaluations are saved as the "
      "most expensive fit of the method took, against the cheapest of the others at the same error",
      "verdict: what happens to the method at the step in a long trial of its own; the data have it in full",
      fmt::format("peak memory {} MB", (peak_memory() + 500'000) / 1'000'000),
      fmt::format("nysalt {}, {}, {}, {:%Y-%m-%d}", version, compiler, machine(),
                  fmt::gmtime(std::time(nullptr)))};
  for (const auto& text : sentences_of_methods(all)) notes.push_back(text);
  for (const auto& text : all.warnings()) notes.push_back(fmt::format("warning: {}", text));
  report.list(notes);
  return report;
}

}  // namespace

namespace {

/// A folder for files of gnuplot, gone with them afterwards.
class drawing_folder {
 public:
  drawing_folder() {
    std::string name = std::filesystem::temp_directory_path() / "nysalt_XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make the folder " + name);
    path_ = name;
  }
  drawing_folder(const drawing_folder&) = delete;
  drawing_folder& operator=(const drawing_folder&) = delete;
  ~drawing_folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The page with its pictures in it. Adds a sentence for those that cannot be drawn.
std::string html_of(const page& report, std::vector<std::string>& warnings) {
  try {
    const drawing_folder folder;
    for (const figure& picture : report.figures()) {
      if (!draw(picture, folder.path(), {"svg"}))
        warnings.push_back(fmt::format("gnuplot could not draw {}, and may not be installed", picture.name));
    }
    return report.html(folder.path());
  } catch (const std::runtime_error& problem) {  // no room for its files
    warnings.push_back(fmt::format("could not draw the pictures: {}", problem.what()));
    return report.html("/dev/null");  // where none is
  }
}

}  // namespace

std::vector<std::string> write_report(const comparison& all, const std::filesystem::path& folder) {
  std::vector<std::string> warnings;
  make_folders(folder);
  write_table(folder / "rows.csv", csv_of(all), all.common());
  json document = document_of(all);
  document["question"] = all.question();
  write_document(folder / "report.json", document, all.common());
  write_result(folder / "report.html", html_of(report_of(all), warnings));
  for (const auto& fit : all.fits()) {
    if (fit.scheme.is_null()) continue;
    make_folders(folder / folder_of_schemes);
    write_document(folder / folder_of_schemes / scheme_file(fit.method, fit.step), fit.scheme, all.common());
  }
  return warnings;
}

}  // namespace nysalt::program
