// SPDX-License-Identifier: BSL-1.0
// Results of a comparison: a JSON document, text and tables.
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "comparison/purpose.hpp"
#include "comparison/refusal.hpp"
#include "comparison_report.hpp"
#include "comparison_tables.hpp"

namespace nysalt::program {

std::int64_t peak_memory() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return 1024 * static_cast<std::int64_t>(used.ru_maxrss);
}

std::string quantity(const comparison& all, std::size_t m) {
  const asked_metric& metric = all.metrics()[m];
  if (metric.name == "path") return "path error of " + metric.observable;
  if (metric.name == "relative") return "relative error of " + metric.observable;
  if (metric.name == "distribution") return "total variation of " + metric.observable;
  if (metric.name == "acf") return "acf error of " + metric.observable;
  if (metric.is_acceptance()) return fmt::format("acceptance at kT = {:g}", all.options().hmc_temperature);
  return metric.name + " error";
}

std::string errors_compared(const comparison& all, std::size_t m) {
  return all.metrics()[m].is_acceptance() ? "rejection rate" : "error";
}

std::string verdict_by_evaluations(const comparison& all, std::size_t m) {
  return verdict_of(best_by(all, m, evaluations_of), evaluations_per_time, errors_compared(all, m));
}

std::string plain_verdict(const comparison& all, std::size_t m) {
  std::string text = verdict_by_evaluations(all, m);
  std::erase(text, '`');
  return text;
}

namespace {

std::string in_short(double x) { return std::isfinite(x) ? fmt::format("{:.2e}", x) : std::string("-"); }

}  // namespace

std::string joined_marks(const comparison& all, std::size_t m, const row& line) {
  std::string text;
  for (const mark one : marks_of(all, m, line)) {
    if (!text.empty()) text += ' ';
    text += to_string(one);
  }
  return text;
}

table rows_of(const comparison& all, std::size_t m) {
  const asked_metric& metric = all.metrics()[m];
  std::vector<std::string> names{"method",   "step",         "evaluations/time", "ns/time",
                                 "median +", metric.value(), "standard error"};
  const bool has_spread = metric.is_along_paths();
  if (has_spread) names.insert(names.end(), {"median error", "5 % to 95 %"});
  names.insert(names.end(), {"diverged", "verdict", "marks"});
  table result(names);
  const auto shown = [&](double x) {
    return metric.is_acceptance() && std::isfinite(x) ? fmt::format("{:.4f}", x) : in_short(x);
  };
  for (const row& line : all.rows()) {
    const measurement& one = line.measurements[m];
    const timed_job& seconds = line.seconds_per_time;
    std::vector<std::string> cells{line.method,
                                   fmt::format("{:g}", line.nominal),
                                   fmt::format("{:.1f}", line.evaluations_per_time),
                                   fmt::format("{:.0f}", 1e9 * seconds.least),
                                   fmt::format("{:.0f} %", 100.0 * (seconds.median / seconds.least - 1.0)),
                                   shown(one.value.mean),
                                   in_short(one.value.standard_error)};
    if (has_spread) {
      const method_error::distribution spread = spread_of(one);
      cells.push_back(in_short(spread.median.mean));
      const bool is_known = one.spread && std::isfinite(spread.quantiles.front());
      cells.push_back(is_known ? fmt::format("{} to {}", in_short(spread.quantiles.front()),
                                             in_short(spread.quantiles.back()))
                               : "-");
    }
    cells.push_back(fmt::format("{}/{}", one.diverged, all.options().trajectories));
    cells.push_back(line.judged ? std::string(to_string(line.judged->verdict)) : std::string("-"));
    cells.push_back(joined_marks(all, m, line));
    result.add(cells);
  }
  for (const auto& [name, value] : free_of_cost(all, m)) {
    std::vector<std::string> cells{name, "-", "0.0", "0", "-", in_short(value), "-"};
    if (has_spread) cells.insert(cells.end(), {"-", "-"});
    cells.insert(cells.end(), {"-", "-", ""});
    result.add(cells);
  }
  return result;
}

std::vector<std::pair<std::string, double>> free_of_cost(const comparison& all, std::size_t m) {
  std::vector<std::pair<std::string, double>> result;
  const auto add = [&](const char* name, std::optional<double> baseline::*field) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [key, context] : all.measured_baselines()) {
      if (key.first == m) least = std::min(least, (context.*field).value_or(least));
    }
    if (std::isfinite(least)) result.emplace_back(name, least);
  };
  add("null model", &baseline::null_model);
  add("floor of sampling", &baseline::floor);
  return result;
}

std::vector<std::string> meanings_of_marks(const comparison& all, std::size_t m) {
  std::vector<std::string> result;
  for (const mark one : {mark::reference, mark::null, mark::floor, mark::horizon, mark::tail, mark::formula,
                         mark::processed, mark::volume, mark::edge, mark::loses, mark::diverged}) {
    const bool is_there = std::ranges::any_of(
        all.rows(), [&](const row& line) { return std::ranges::count(marks_of(all, m, line), one) > 0; });
    if (is_there) result.push_back(fmt::format("`{}`: {}", to_string(one), meaning(one)));
  }
  return result;
}

namespace {

/// The context of rows of one reference: the worst of it over their steps.
struct span_of_steps {
  double from;
  double to;
  baseline worst;
};

void worsen(baseline& all, const baseline& context) {
  const auto take = [](std::optional<double>& a, const std::optional<double>& b, bool larger) {
    if (!a || (b && (larger ? *b > *a : *b < *a))) a = b;
  };
  take(all.reference_error, context.reference_error, true);
  take(all.null_model, context.null_model, false);
  take(all.floor, context.floor, true);
  take(all.predictable_until, context.predictable_until, false);
}

std::vector<span_of_steps> spans_of(const comparison& all, std::size_t m) {
  std::vector<span_of_steps> result;
  for (const auto& [key, context] : all.measured_baselines()) {
    if (key.first != m || context.reference.empty()) continue;
    if (result.empty() || result.back().worst.reference != context.reference) {
      result.push_back({key.second, key.second, context});
    }
    result.back().to = key.second;
    worsen(result.back().worst, context);
  }
  return result;
}

}  // namespace

table baselines_of(const comparison& all, std::size_t m) {
  const bool is_of_law = all.metrics()[m].is_of_law();
  table result({"step sizes", "reference", is_of_law ? "its finer self, at most" : "its own error, at most",
                "null model, at least", is_of_law ? "floor of sampling" : "predictable until"},
               2);
  const auto shown = [](const std::optional<double>& x) { return x ? in_short(*x) : std::string("-"); };
  for (const auto& [from, to, worst] : spans_of(all, m)) {
    const auto until = worst.predictable_until;
    const std::string horizon = !until ? "-" : std::isinf(*until) ? "the end" : fmt::format("{:g}", *until);
    result.add({from == to ? fmt::format("{:g}", from) : fmt::format("{:g} to {:g}", from, to),
                worst.reference, shown(worst.reference_error), shown(worst.null_model),
                is_of_law ? shown(worst.floor) : horizon});
  }
  return result;
}

std::string sentence_of_prices(const std::vector<double>& prices) {
  const double whole = std::accumulate(prices.begin(), prices.end(), 0.0);
  std::string shares;
  for (std::size_t part = 0; part < prices.size(); ++part) {
    shares += fmt::format("{}{:.3g} with part {}", part > 0 ? ", " : "", prices[part] / whole, part);
  }
  return fmt::format("Evaluations are those of the whole force, of which a kick costs {}.", shares);
}

table equal_cost_table(const comparison& all, std::size_t m) {
  const asked_metric& metric = all.metrics()[m];
  const bool accepts = metric.is_acceptance();
  std::string value = metric.value();
  if (is_by_median(all, m)) value = "median " + value;
  table result({"at equal cost", "step", value, "best of the others", "its " + value,
                accepts ? "its rejections / learned" : "its error / learned", "its ns / learned"});
  const char* format = accepts ? "{:.4f}" : "{:.2e}";
  for (const at_equal_cost& pair : side_by_side(all, m)) {
    const double seconds = pair.best->seconds_per_time.least / pair.learned->seconds_per_time.least;
    result.add({pair.learned->method, fmt::format("{:g}", pair.learned->nominal),
                fmt::format(fmt::runtime(format), ranked_value(all, m, *pair.learned).mean),
                pair.best->method, fmt::format(fmt::runtime(format), ranked_value(all, m, *pair.best).mean),
                with_error(gain(all, m, pair)), fmt::format("{:.2g}", seconds)});
  }
  return result;
}

std::vector<std::string> reasons_of(const comparison& all, std::size_t m) {
  std::vector<std::string> result;
  for (const row& line : all.rows()) {
    const std::string& reason = line.measurements[m].reason;
    if (!reason.empty())
      result.push_back(fmt::format("{} at step {:g}: {}", line.method, line.nominal, reason));
  }
  return result;
}

std::vector<std::string> sentences_of_methods(const comparison& all) {
  std::map<std::string, std::vector<std::string>> by_frequency;
  for (const row& line : all.rows()) {
    if (!line.frequency) continue;
    auto& names = by_frequency[in_words(*line.frequency)];
    if (std::ranges::count(names, line.method) == 0) names.push_back(line.method);
  }
  std::vector<std::string> result;
  for (const auto& [frequency, names] : by_frequency) {
    result.push_back(fmt::format("fitted to {}: {}", frequency, listed(names)));
  }
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const auto& [name, reason] : all.left_out()) {
    auto& names = by_reason[reason];
    if (std::ranges::count(names, name) == 0) names.push_back(name);
  }
  for (const auto& [reason, names] : by_reason) {
    result.push_back(fmt::format("left out: {}: {}", listed(names), reason));
  }
  return result;
}

namespace {

/// A row, and how it compares with the best that costs no more.
struct placed_row {
  const row* line;
  double ratio;  // of its error to that of the best; NaN: it is not compared
  bool is_best;  // or not separated from it
};

placed_row place_of(const comparison& all, std::size_t m, const row& line,
                    const std::vector<best_at_cost>& found) {
  placed_row result{&line, std::nan(""), false};
  if (!is_ranked(all, m, line)) return result;
  const auto is_of_row = [&](const ranked_method& one) {
    return one.method == line.method && one.step == line.nominal;
  };
  const double own = ranked_value(all, m, line).mean;
  for (const best_at_cost& one : found) {
    if (one.cost < line.evaluations_per_time || one.best.empty()) continue;
    const bool is_best = std::ranges::any_of(one.best, is_of_row);
    // Costs of one rung may differ by the evaluation of the start: a row is seen where it leads, if it does.
    if (std::isnan(result.ratio) || (is_best && !result.is_best))
      result = {&line, std::max(1.0, own / one.best.front().error), is_best};
    if (is_best) break;
  }
  return result;
}

/// The rows, those first that are best at their cost, those last that are not ranked.
std::vector<placed_row> rows_by_rank(const comparison& all, std::size_t m) {
  const auto found = best_by(all, m, evaluations_of);
  std::vector<placed_row> result;
  for (const row& line : all.rows()) result.push_back(place_of(all, m, line, found));
  const auto group = [&](const placed_row& one) {
    const bool is_there = one.line->measurements[m].reason.empty();
    return one.is_best ? 0 : !std::isnan(one.ratio) ? 1 : is_there ? 2 : 3;
  };
  std::ranges::stable_sort(result, [&](const placed_row& a, const placed_row& b) {
    if (group(a) != group(b)) return group(a) < group(b);
    if (group(a) == 1) return a.ratio < b.ratio;
    return group(a) == 0 && ranked_value(all, m, *a.line).mean < ranked_value(all, m, *b.line).mean;
  });
  return result;
}

}  // namespace

table ranking_of(const comparison& all, std::size_t m) {
  const bool accepts = all.metrics()[m].is_acceptance();
  table result(
      {"rank", "method", "step", "evaluations/time",
       (is_by_median(all, m) ? "median " : "") + all.metrics()[m].value(), "times the best", "marks"},
      2);
  std::set<std::string> ahead;  // methods
  for (const auto& [line, ratio, is_best] : rows_by_rank(all, m)) {
    const estimate value = ranked_value(all, m, *line);
    std::string shown =
        accepts && std::isfinite(value.mean) ? fmt::format("{:.4f}", value.mean) : in_short(value.mean);
    if (std::isfinite(value.standard_error)) shown += fmt::format(" ± {:.0e}", value.standard_error);
    const bool is_there = line->measurements[m].reason.empty();
    result.add({is_best             ? "1"
                : std::isnan(ratio) ? "-"
                                    : fmt::format("{}", ahead.size() + 1 - ahead.count(line->method)),
                line->method, fmt::format("{:g}", line->nominal),
                fmt::format("{:.1f}", line->evaluations_per_time), shown,
                std::isnan(ratio) || std::isinf(ratio) ? "-" : fmt::format("{:.3g}", ratio),
                is_there ? joined_marks(all, m, *line) : "no value"});
    ahead.insert(line->method);
  }
  return result;
}

namespace {

/// "null: no better than the null model; tail: few trajectories decide the mean"
std::string short_meanings_of_marks(const comparison& all, std::size_t m) {
  std::string text;
  for (const std::string& one : meanings_of_marks(all, m)) {
    text += (text.empty() ? "" : "; ") + one.substr(0, one.find_first_of(";:", one.find(':') + 1));
  }
  return text;
}

/// All columns of the rows, what they are seen against, and all notes.
std::string details_of(const comparison& all, std::size_t m) {
  std::string text;
  if (const table against = baselines_of(all, m); !against.empty()) text += against.text() + "\n";
  text += rows_of(all, m).text();
  for (const auto& sentence : meanings_of_marks(all, m)) text += sentence + "\n";
  for (const auto& sentence : reasons_of(all, m)) text += sentence + "\n";
  if (const table beside = equal_cost_table(all, m); !beside.empty()) text += "\n" + beside.text();
  return text;
}

}  // namespace

std::string readable(const comparison& all, const text_form& form) {
  const comparison_options& options = all.options();
  const bool is_one = all.metrics().size() == 1;
  std::string text;
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    text += wrapped((is_one ? "" : quantity(all, m) + ": ") + plain_verdict(all, m), form.width);
  }
  text += wrapped(fmt::format("\n{}, {} trajectories over {:g}; starts: {}", all.system().description(),
                              options.trajectories, all.horizon(), all.system().starts()),
                  form.width);
  if (options.equal_cost)
    text += wrapped("steps are per force evaluation: equal steps, equal cost", form.width);
  if (!options.prices.empty()) text += wrapped(sentence_of_prices(options.prices), form.width);
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    text += fmt::format("\n{}\n\n{}", quantity(all, m), ranking_of(all, m).text(form.width));
    text += wrapped_plainly(short_meanings_of_marks(all, m), form.width);
    if (form.is_verbose) text += "\n" + details_of(all, m);
  }
  if (!all.fits().empty()) {
    const auto advice = advice_on_purpose(all.metrics(), options.learning.purpose);
    text += "\n" + wrapped(report_of_purpose(options.learning) + "\n" + advice, form.width);
  }
  if (!form.is_verbose) return text;
  for (const auto& sentence : sentences_of_methods(all)) text += "\n" + sentence;
  return text + fmt::format("\npeak memory: {} MB\n", (peak_memory() + 500'000) / 1'000'000);
}

}  // namespace nysalt::program
