// SPDX-License-Identifier: BSL-1.0
// Results of a recommendation for sampling, as JSON and as text.
#include <cmath>

#include "comparison/learned_row.hpp"
#include "comparison/method_file.hpp"
#include "comparison/sampling_choice.hpp"
#include "table.hpp"
#include "terminal.hpp"

namespace nysalt::program {

namespace {

json finite_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

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

json sampling_choice::document() const {
  const auto name_of = [](const sampling_candidate* one) {
    return one == nullptr ? json(nullptr) : json(one->source.typed);
  };
  const auto* learned = best_of(true);
  const auto* classical = best_of(false);
  const auto* verlet = named("verlet");
  const auto as_json = [](const sampling_ratio& ratio) {
    return json{{"value", finite_or_null(ratio.value)},
                {"standard_error", finite_or_null(ratio.standard_error)}};
  };
  json result{{"system", system_->description()},
              {"states", states_ ? states_->description() : std::string()},
              {"length", options_.length},
              {"acceptance", options_.acceptance},
              {"temperature", options_.temperature},
              {"times_larger", options_.times_larger},
              {"trajectories", options_.trajectories},
              {"seed", common_.seed},
              {"verdict", verdict()},
              {"winner", name_of(taken())},
              {"best_learned", name_of(learned)},
              {"best_classical", name_of(classical)},
              {"ratio", nullptr},
              {"diagnostic", nullptr},
              {"advice", advice()}};
  if (learned != nullptr && classical != nullptr) result["ratio"] = as_json(ratio_of(*learned, *classical));
  if (const auto* two = named("mclachlan2v"); two != nullptr && verlet != nullptr) {
    result["diagnostic"] = as_json(ratio_of(*two, *verlet));
  }
  json rows = json::array();
  json fits = json::array();
  for (const auto& one : all_) {
    json row{{"method", one.source.typed},
             {"learned", one.is_learned()},
             {"evaluations_per_step", one.source.evaluations_per_step},
             {"step_size", nullptr},
             {"step_per_evaluation", nullptr},
             {"standard_error", nullptr},
             {"is_longest", false},
             {"learned_at", one.plan ? json(one.plan->step) : json(nullptr)},
             {"over_verlet", nullptr}};
    if (one.is_eligible()) {
      row["step_size"] = one.found->step;
      row["step_per_evaluation"] = one.step_of_evaluation();
      row["standard_error"] = finite_or_null(one.step_of_evaluation() * one.found->log_step.standard_error);
      row["is_longest"] = one.found->is_longest;
      if (verlet != nullptr) row["over_verlet"] = as_json(ratio_of(one, *verlet));
    }
    if (!one.reason.empty()) row["reason"] = one.reason;
    rows.push_back(row);
    if (!one.learned) continue;
    json fit{{"method", one.source.typed}};
    fit.update(fit_json(one.learned->fit));
    fits.push_back(fit);
  }
  json left_out = json::array();
  for (const auto& [name, reason] : left_out_) left_out.push_back({{"method", name}, {"reason", reason}});
  result["rows"] = rows;
  result["fits"] = fits;
  result["left_out"] = left_out;
  result["warnings"] = warnings_;
  return result;
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
