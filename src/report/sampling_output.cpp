// SPDX-License-Identifier: BSL-1.0
// Results of a recommendation for sampling, as JSON and as text.
#include <cmath>

#include "comparison/method_file.hpp"
#include "comparison/sampling_choice.hpp"
#include "method_row.hpp"
#include "table.hpp"
#include "terminal.hpp"

namespace nysalt::program {

namespace {

std::string in_words(const sampling_ratio& ratio) {
  return fmt::format("{:.3f} +- {:.1g}", ratio.value, ratio.standard_error);
}

}  // namespace

/// The gain of two stages over one: a first sign of whether any word will help.
std::string sampling_choice::diagnostic() const {
  const auto* verlet = named("verlet");
  const auto* two = named("mclachlan2v");
  if (verlet == nullptr || two == nullptr) return {};
  const auto ratio = ratio_of(*two, *verlet);
  const std::string fact =
      fmt::format("mclachlan2v takes {} times the step per evaluation of verlet", in_words(ratio));
  if (ratio.is_above_one()) return fact + ": the choice of the word matters here.";
  return fact + ": two stages gain nothing here.";
}

std::string sampling_choice::advice() const {
  const auto* best = taken();
  if (best == nullptr) return "No word is accepted so often at any step.";
  const std::string what = fmt::format("{} at step {:.4g}, {:.4g} an evaluation", best->source.typed,
                                       best->found->step, best->step_of_evaluation());
  const auto* verlet = named("verlet");
  const std::string beside =
      verlet == nullptr || verlet == best
          ? std::string()
          : fmt::format(", {} times that of verlet", in_words(ratio_of(*best, *verlet)));
  if (best->found->is_longest) {
    return fmt::format(
        "Take {}: even trajectories of one step are accepted more often than asked; a longer "
        "{} costs nothing.",
        what, spelled("length"));
  }
  const auto* learned = best_of(true);
  const auto* classical = best_of(false);
  if (learned == nullptr || classical == nullptr) return fmt::format("Take {}{}.", what, beside);
  const auto ratio = ratio_of(*learned, *classical);
  if (verdict() == "tie") {
    return fmt::format(
        "A tie: take {}{}; {}, the best that was learned, takes {} times its step per evaluation.", what,
        beside, learned->source.typed, in_words(ratio));
  }
  if (best == classical) {
    return fmt::format(
        "A classical word wins: take {}{}; {}, the best that was learned, takes {} times its "
        "step per evaluation.",
        what, beside, learned->source.typed, in_words(ratio));
  }
  return fmt::format(
      "Take {}: {} times the step per evaluation of {}, the best classical word{}. It was learned at step "
      "{:.4g}, which its scheme is of.",
      what, in_words(ratio), classical->source.typed, beside, best->plan->step);
}

std::optional<chosen_method> sampling_choice::chosen() const {
  const auto* best = taken();
  if (best == nullptr) return std::nullopt;
  const double step = best->found->step;
  return chosen_method{.name = best->source.typed,
                       .step = step,
                       .text = best->is_learned()
                                   ? scheme_text({*best->learned}, *system_, *best->plan)
                                   : table_text(best->source.typed, method_at(*best, step), step, *system_)};
}

namespace {

/// A word at the step at which it is accepted as often as asked.
struct sampling_row {
  std::string method;
  bool learned;
  int evaluations_per_step;
  std::optional<double> step_size{};
  std::optional<double> step_per_evaluation{};
  std::optional<double> standard_error{};
  bool is_longest = false;
  std::optional<double> learned_at{};
  std::optional<sampling_ratio> over_verlet{};
  std::string reason{};
};

struct sampling_result : sampling_options {
  std::string system;
  std::string states;
  std::uint64_t seed;
  std::string verdict;
  std::string winner;
  std::string best_learned;
  std::string best_classical;
  std::optional<sampling_ratio> ratio;       // of the best that was learned to the best classical word
  std::optional<sampling_ratio> diagnostic;  // of mclachlan2v to verlet
  std::string advice;
  std::vector<sampling_row> rows;
  std::vector<learned_fit> fits;
  std::vector<left_out_method> left_out;
  std::vector<std::string> warnings;
  std::string output{};  // the file of the word to take, if that was written
};

}  // namespace

NYSALT_DESCRIBED(sampling_ratio, value, standard_error)
NYSALT_DESCRIBED(sampling_row, method, learned, evaluations_per_step, step_size, step_per_evaluation,
                 standard_error, is_longest, learned_at, over_verlet, reason)
NYSALT_DESCRIBED(sampling_result, system, states, length, acceptance, temperature, times_larger, trajectories,
                 seed, verdict, winner, best_learned, best_classical, ratio, diagnostic, advice, rows, fits,
                 left_out, warnings, output)

json sampling_choice::schema() { return whole_schema<sampling_result>("nysalt recommend for sampling"); }

json sampling_choice::document() const {
  const auto name_of = [](const sampling_candidate* one) {
    return one == nullptr ? std::string() : one->source.typed;
  };
  const auto ratio_if_both = [&](const sampling_candidate* a, const sampling_candidate* b) {
    return a == nullptr || b == nullptr ? std::nullopt : std::optional(ratio_of(*a, *b));
  };
  const auto* learned = best_of(true);
  const auto* classical = best_of(false);
  const auto* verlet = named("verlet");
  sampling_result result{options_,
                         system_->description(),
                         states_ ? states_->description() : std::string(),
                         common_.seed,
                         verdict(),
                         name_of(taken()),
                         name_of(learned),
                         name_of(classical),
                         ratio_if_both(learned, classical),
                         ratio_if_both(named("mclachlan2v"), verlet),
                         advice(),
                         {},
                         {},
                         left_out_of(left_out_),
                         warnings_};
  for (const auto& one : all_) {
    sampling_row row{one.source.typed, one.is_learned(), one.source.evaluations_per_step};
    if (one.plan) row.learned_at = one.plan->step;
    row.reason = one.reason;
    if (one.is_eligible()) {
      row.step_size = one.found->step;
      row.step_per_evaluation = one.step_of_evaluation();
      row.standard_error = one.step_of_evaluation() * one.found->log_step.standard_error;
      row.is_longest = one.found->is_longest;
      row.over_verlet = ratio_if_both(&one, verlet);
    }
    result.rows.push_back(row);
    if (one.learned) result.fits.push_back(fit_of(*one.learned, one.plan->how, one.plan->where, row.method));
  }
  return whole_document(result);
}

std::string sampling_choice::readable(const text_form& form) const {
  std::string question =
      fmt::format("{}: Hybrid Monte Carlo at kT = {:g}, trajectories of mean length {:g}, acceptance {:g}",
                  system_->description(), options_.temperature, options_.length, options_.acceptance);
  if (options_.times_larger != 1.0)
    question += fmt::format(", a system {:g} times larger", options_.times_larger);
  question += fmt::format("; {} states of {}\n{}", options_.trajectories,
                          states_ ? states_->description() : std::string(), diagnostic());
  table rows({"rank", "method", "evaluations", "step", "step/evaluation", "over verlet", "marks"}, 2);
  const auto* verlet = named("verlet");
  for (const auto& one : all_) {
    if (!one.is_eligible()) continue;
    const double step = one.step_of_evaluation();
    rows.add({fmt::format("{}", rows.size() + 1), one.source.typed,
              fmt::format("{}", one.source.evaluations_per_step), fmt::format("{:.4g}", one.found->step),
              fmt::format("{:.4g} ± {:.0e}", step, step * one.found->log_step.standard_error),
              verlet == nullptr ? "-" : in_words(ratio_of(one, *verlet)), one.is_learned() ? "learned" : ""});
  }
  std::string text = wrapped(advice() + "\n\n" + question, form.width) + "\n" + rows.text(form.width);
  if (!form.is_verbose) return text;
  for (const auto& one : all_) {
    if (!one.reason.empty()) text += fmt::format("{}: {}\n", one.source.typed, one.reason);
  }
  for (const auto& [name, reason] : left_out_) text += fmt::format("left out: {}: {}\n", name, reason);
  return text;
}

}  // namespace nysalt::program
