// SPDX-License-Identifier: BSL-1.0
// Results of a recommendation, as JSON and as text.
#include <algorithm>
#include <cmath>

#include "comparison/learning.hpp"
#include "comparison/method_file.hpp"
#include "comparison/purpose.hpp"
#include "comparison/ranking.hpp"
#include "comparison/recommendation.hpp"
#include "method_row.hpp"
#include "table.hpp"
#include "terminal.hpp"

namespace nysalt::program {

namespace {

std::string in_words(const ratio_estimate& ratio) {
  if (std::isinf(ratio.value)) return "zero, and so smaller";
  std::string value = fmt::format("{:.3g} times smaller", ratio.value);
  if (std::isnan(ratio.low)) return value;
  return fmt::format("{} (95 %: {:.3g} to {:.3g})", value, ratio.low, ratio.high);
}

/// "1.3 times the seconds"
std::string multiple_of(double ratio, double tolerance, const char* what, const std::string& same) {
  if (std::abs(std::log(ratio)) <= tolerance) return same;
  return fmt::format("{:.2g} times the {}", ratio, what);
}

}  // namespace

std::string recommendation::as_settings(const candidate& contender) const {
  std::vector<std::string> settings{spelled("method", contender.source.typed),
                                    spelled("step", contender.step)};
  if (!options_.placement.empty()) settings.push_back(spelled("placement", options_.placement));
  return spelled_together(settings);
}

/// The cost of one relative to the other: "as many evaluations and 1.3 times the seconds".
std::string recommendation::costs(const candidate& contender, const candidate& other) const {
  constexpr double start_up = 0.05;  // a start costs one evaluation, of twenty at least
  const double noise = noise_of(contender, other);
  return multiple_of(contender.evaluations_per_time / other.evaluations_per_time, start_up, "evaluations",
                     "as many evaluations") +
         " and " +
         multiple_of(contender.seconds_per_time / other.seconds_per_time, noise, "seconds",
                     fmt::format("the same seconds within {:.2g} %", 100.0 * noise));
}

/// Of errors below the one asked for.
std::string recommendation::bound_of(const contest& among, const candidate& contender) const {
  if (!options_.error || !contender.confirmed) return {};
  return fmt::format(", where {} is {:.2e}, and with 97.7 % confidence at most {:.2e}",
                     among.statistic.is_quantile ? "the error of 95 of 100 trajectories" : "the error",
                     among.statistic(contender.confirmed->scores),
                     among.statistic.upper_bound(contender.confirmed->scores));
}

std::string recommendation::advice_of(const contest& among) const {
  const candidate* learned = among.best_of(true);
  const candidate* classical = among.best_of(false);
  if (!among.has_result()) {
    return "No method stays with the reference and is stable: take more evaluations, or a shorter horizon.";
  }
  if (learned == nullptr) {
    return fmt::format("A classical method wins: {}{}. No learned method is accepted.",
                       as_settings(*classical), bound_of(among, *classical));
  }
  if (classical == nullptr) {
    return fmt::format("Take {} at step {:.12g}{}: no classical method is accepted.", learned->source.typed,
                       learned->step, bound_of(among, *learned));
  }
  const candidate* best = among.winner();
  const ratio_estimate ratio = among.error_ratio(*classical, *learned);
  if (best == nullptr) {
    const std::string within =
        std::isnan(ratio.low) || !among.budget
            ? std::string()
            : fmt::format(" (the ratio of their errors is {:.3g}, 95 %: {:.3g} to {:.3g})", ratio.value,
                          ratio.low, ratio.high);
    return fmt::format("A tie: {} and {} do not differ significantly{}. The latter needs no learning: {}{}.",
                       learned->source.typed, classical->source.typed, within, as_settings(*classical),
                       bound_of(among, *classical));
  }
  const bool is_learned = best == learned;
  const candidate& other = is_learned ? *classical : *learned;
  const std::string rival = is_learned ? fmt::format("{}, the best classical method", other.source.typed)
                                       : fmt::format("{}, the best that was learned", other.source.typed);
  const std::string why =
      among.budget ? fmt::format("its error is {} than that of {}, at {}",
                                 in_words(is_learned ? ratio : ratio.inverse()), rival, costs(*best, other))
                   : fmt::format("it takes {} of {}{}", costs(*best, other), rival, bound_of(among, *best));
  if (is_learned) return fmt::format("Take {} at step {:.12g}: {}.", best->source.typed, best->step, why);
  return fmt::format("A classical method wins: {}; {}.", as_settings(*best), why);
}

/// Whether seconds say the same as evaluations, and if not, who wins by them.
std::string recommendation::advice_on_seconds() const {
  if (!by_evaluations_ || !by_evaluations_->has_result() || !by_seconds_->has_result()) return {};
  const candidate* first = by_evaluations_->taken();
  const candidate* fast = by_seconds_->taken();
  if (first == nullptr || fast == nullptr) return {};
  std::string same = fmt::format(" By seconds {} is the choice too.", first->source.typed);
  if (fast->source.typed == first->source.typed) return same;
  const std::string method_at_step = fmt::format("{} at step {:.4g}", fast->source.typed, fast->step);
  if (!options_.budget) {
    const double ratio = first->seconds_per_time / fast->seconds_per_time;
    if (!(ratio > by_seconds_->cost_ratio)) return same;
    return fmt::format(
        " By seconds another wins: {} takes {:.2g} times fewer of them, {:.0f} ns per unit time, "
        "and {:.2g} times the evaluations{}.",
        method_at_step, ratio, 1e9 * fast->seconds_per_time,
        fast->evaluations_per_time / first->evaluations_per_time, bound_of(*by_seconds_, *fast));
  }
  const ratio_estimate ratio = by_seconds_->error_ratio(*first, *fast);
  if (!ratio.is_above_one()) {
    return fmt::format(" In the same seconds the best, {}, is not better by more than chance.",
                       fast->source.typed);
  }
  return fmt::format(
      " By seconds another wins: in the same {:.0f} ns per unit time the error of {} is {}, at {:.2g} "
      "times the evaluations ({} {:.3g}).",
      1e9 * first->seconds_per_time, method_at_step, in_words(ratio),
      fast->evaluations_per_time / first->evaluations_per_time, spelled("budget_seconds"),
      first->seconds_per_time);
}

/// The cost of observations of a processed method, where one is advised.
std::string recommendation::advice_on_observations() const {
  const candidate* best = asked().taken();
  if (best == nullptr || best->source.evaluations_to_observe == 0) return {};
  return fmt::format(
      " {} is counted with {} observation{} of each trajectory ({}): every further one takes {} "
      "evaluations.",
      best->source.typed, options_.looks, options_.looks == 1 ? "" : "s", spelled("looks"),
      best->source.evaluations_to_observe);
}

std::string recommendation::advice() const {
  return advice_of(asked()) + advice_on_seconds() + advice_on_observations();
}

std::optional<chosen_method> recommendation::chosen() const {
  const candidate* best = asked().taken();
  if (best == nullptr) return std::nullopt;
  chosen_method result{.name = best->source.typed, .step = best->step, .text = {}};
  if (best->is_learned()) {
    const auto plan = plan_for(*best->source.family, best->where, best->step, options_.learning, common_);
    result.text = scheme_text({*best->learned}, *system_, plan);
  } else {
    result.text = table_text(best->source.typed, *best->method, best->step, *system_);
  }
  return result;
}

std::string recommendation::quantity() const {
  if (options_.metric == "path") return "path error of " + options_.observable;
  if (options_.metric == "acceptance") return fmt::format("rejection at kT = {:g}", options_.hmc_temperature);
  return options_.metric + " error";
}

method_row recommendation::row_of(const contest& among, const candidate& contender) const {
  const measured_error& error = contender.error;
  method_row row{.metric = metric().text(),
                 .method = contender.source.typed,
                 .step = contender.step,
                 .step_size = contender.step,
                 .evaluations_per_time = contender.evaluations_per_time,
                 .seconds_per_time = contender.seconds_per_time,
                 .error = error.mean.mean,
                 .standard_error = error.mean.standard_error,
                 .survivors = error.trajectories - error.diverged,
                 .diverged = error.diverged,
                 .reason = contender.reason,
                 .learned = contender.is_learned(),
                 .order = contender.order,
                 .reversible = contender.symmetric,
                 .rotation = contender.rotates,
                 .evaluations_per_step = contender.source.evaluations_per_step,
                 .reference_error = contender.reference_error,
                 .frequency = frequency_of(contender.source, *system_)};
  if (error.is_heavy) row.marks.push_back(to_string(mark::tail));
  if (contender.is_ranked()) row.quantile_95 = quantile_of(error);
  if (contender.confirmed && contender.reason.empty()) {
    const auto& scores = contender.confirmed->scores;
    row.confirmed = {among.statistic(scores), among.statistic.upper_bound(scores)};
  }
  return row;
}

double recommendation::quantile_of(const measured_error& error) const {
  return statistic(true)(error.scores);
}

namespace {

/// Who wins at one cost or error, and by how much: classical over learned.
struct contest_result {
  std::string verdict;
  std::string winner;
  std::string best_learned;
  std::string best_classical;
  std::string judged_by;
  std::optional<ratio_estimate> error_ratio{};
  std::optional<double> evaluations_ratio{};
  std::optional<double> seconds_ratio{};
  std::vector<method_row> rows{};
};

struct recommendation_result : recommendation_options, contest_result {
  std::string system;
  std::string starts;
  std::uint64_t seed;
  std::string advice;
  contest_result by_seconds;
  std::vector<learned_fit> fits;
  std::vector<left_out_method> left_out;
  std::vector<std::string> warnings;
  std::string output{};  // the file of the method to take, if that was written
};

contest_result result_of(const contest& among) {
  const auto name_of = [](const candidate* contender) {
    return contender == nullptr ? std::string() : contender->source.typed;
  };
  const candidate* learned = among.best_of(true);
  const candidate* classical = among.best_of(false);
  contest_result result{among.verdict(), name_of(among.winner()), name_of(learned), name_of(classical),
                        among.statistic.is_quantile ? "quantile" : "mean"};
  if (learned == nullptr || classical == nullptr) return result;
  result.error_ratio = among.error_ratio(*classical, *learned);
  result.evaluations_ratio = classical->evaluations_per_time / learned->evaluations_per_time;
  result.seconds_ratio = classical->seconds_per_time / learned->seconds_per_time;
  return result;
}

}  // namespace

NYSALT_DESCRIBED(ratio_estimate, value, low, high)
NYSALT_DESCRIBED(contest_result, verdict, winner, best_learned, best_classical, judged_by, error_ratio,
                 evaluations_ratio, seconds_ratio, rows)
constexpr auto members(of<recommendation_result>) {
  using result = recommendation_result;
  return std::tuple(NYSALT_MEMBERS(result, system, starts, metric, observable, budget, budget_seconds, error,
                                   horizon, trajectories, seed),
                    item{"purpose", [](const result& all) { return all.learning.purpose; }},
                    NYSALT_MEMBERS(result, verdict, winner, best_learned, best_classical, judged_by,
                                   error_ratio, evaluations_ratio, seconds_ratio, advice, by_seconds, rows,
                                   fits, left_out, warnings, output));
}

json recommendation::schema() { return whole_schema<recommendation_result>("nysalt recommend"); }

json recommendation::document() const {
  const auto with_rows = [&](const contest& among) {
    contest_result result = result_of(among);
    for (const candidate& contender : among.all) result.rows.push_back(row_of(among, contender));
    return result;
  };
  recommendation_result result{options_,
                               with_rows(asked()),
                               system_->description(),
                               system_->starts(),
                               common_.seed,
                               advice(),
                               with_rows(*by_seconds_),
                               {},
                               left_out_of(left_out_),
                               warnings_};
  if (options_.metric != "path") result.observable.clear();
  for (const candidate& contender : asked().all) {
    if (!contender.learned) continue;
    result.fits.push_back(
        fit_of(*contender.learned, options_.learning, contender.where, contender.source.typed));
  }
  return whole_document(result);
}

namespace {

std::string in_short(const char* format, double x) {
  return std::isfinite(x) ? fmt::format(fmt::runtime(format), x) : std::string("-");
}

}  // namespace

std::string recommendation::readable(const text_form& form) const {
  const contest& among = asked();
  std::string question = fmt::format("{}, {} fresh trajectories over {:g}, {}", system_->description(),
                                     options_.trajectories, options_.horizon, quantity());
  if (options_.budget) question += fmt::format(", {:g} evaluations per unit time", *options_.budget);
  if (options_.budget_seconds)
    question += fmt::format(", {:g} ns per unit time", 1e9 * *options_.budget_seconds);
  if (options_.error) question += fmt::format(" below {:g}", *options_.error);
  question += fmt::format("; starts: {}\n{}\n", system_->starts(), report_of_purpose(options_.learning));
  const asked_metric judged_by = metric();
  question += advice_on_purpose({&judged_by, 1}, options_.learning.purpose);

  constexpr std::size_t shown = 12;  // of the candidates by rank: the others are details
  const candidate* best = among.best();
  table ranking({"rank", "method", "step", "evaluations/time", "ns/time",
                 among.statistic.is_quantile ? "95 % err below" : "error", "ratio", "marks"},
                2);
  for (const auto& contender : among.all) {
    const std::size_t k = ranking.size();
    if (!form.is_verbose && k == shown) break;
    const bool is_ranked = contender.is_eligible();
    const bool has_error = contender.is_ranked();
    std::string error = in_short("{:.2e}", has_error ? among.error_of(contender) : contender.error.mean.mean);
    if (!among.statistic.is_quantile && std::isfinite(contender.error.mean.standard_error))
      error += fmt::format(" ± {:.0e}", contender.error.mean.standard_error);
    const double ratio = !has_error     ? std::nan("")
                         : among.budget ? among.error_of(contender) / among.error_of(*best)
                                        : among.cost_of(contender) / among.cost_of(*best);
    std::string marks = contender.is_learned() ? "learned" : "";
    const auto add = [&](bool is_there, const char* mark) {
      if (is_there) marks += (marks.empty() ? "" : " ") + std::string(mark);
    };
    add(contender.error.is_heavy, "tail");
    add(contender.error.diverged > 0, "diverged");
    add(contender.is_left_behind, "behind");
    add(!contender.reason.empty() && !contender.is_left_behind, "refused");
    ranking.add({is_ranked ? fmt::format("{}", k + 1) : "-", contender.source.typed,
                 in_short("{:.4g}", contender.step), in_short("{:.1f}", contender.evaluations_per_time),
                 in_short("{:.0f}", 1e9 * contender.seconds_per_time), error, in_short("{:.3g}", ratio),
                 marks});
  }
  std::string text = wrapped(advice() + "\n\n" + question, form.width) + "\n" + ranking.text(form.width);
  if (ranking.size() < among.all.size())
    text += fmt::format("and {} more, in the details\n", among.all.size() - ranking.size());
  if (among.statistic.is_quantile) {
    text += wrapped(
        "tail: the mean error rests on few trajectories; ranked by what 95 of 100 trajectories err less than",
        form.width);
  }
  if (std::ranges::any_of(among.all, &candidate::is_left_behind)) {
    text += wrapped(fmt::format("behind: left behind, judged on fewer than {} trajectories, on which {}",
                                options_.trajectories,
                                options_.error ? "the cost was too far above the least"
                                               : "the error was larger than the least by more than chance"),
                    form.width);
  }
  if (!form.is_verbose) return text;
  table all({"method", "order", "mean error", "standard error", "95 % err below", "diverged"});
  for (const auto& contender : among.all) {
    all.add({contender.source.typed, fmt::format("{}", contender.order),
             in_short("{:.2e}", contender.error.mean.mean),
             in_short("{:.1e}", contender.error.mean.standard_error),
             in_short("{:.2e}", contender.is_eligible() ? quantile_of(contender.error) : std::nan("")),
             fmt::format("{}/{}", contender.error.diverged, options_.trajectories)});
  }
  text += "\n" + all.text();
  for (const auto& contender : among.all) {
    if (!contender.reason.empty() && !contender.is_left_behind)
      text += fmt::format("{}: {}\n", contender.source.typed, contender.reason);
  }
  std::map<std::string, std::string> by_reason;
  for (const auto& [name, reason] : left_out_) {
    auto& names = by_reason[reason];
    names += names.empty() ? name : ", " + name;
  }
  for (const auto& [reason, names] : by_reason) text += fmt::format("left out: {}: {}\n", names, reason);
  return text;
}

}  // namespace nysalt::program
