// SPDX-License-Identifier: BSL-1.0
// Who wins, for machines and for people.
#include <algorithm>
#include <cmath>

#include "learning.hpp"
#include "method_file.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/report/table.hpp"
#include "recommendation.hpp"

namespace nysalt::program {

bool recommendation::is_better(const candidate& a, const candidate& b) const {
  return command_.budget ? a.error.mean < b.error.mean : a.evaluations_per_time < b.evaluations_per_time;
}

/// Those that stand first, by what is asked for.
void recommendation::rank() {
  if (command_.error) {
    for (auto& its : all_) {
      if (!its.reason.empty() || its.error.mean - 2.0 * its.error.standard_error <= *command_.error) continue;
      its.reason = fmt::format("on fresh trajectories its error is {:.2e}, above {:g}", its.error.mean,
                               *command_.error);
    }
  }
  const auto group = [](const candidate& its) { return its.stands() ? 0 : its.reason.empty() ? 1 : 2; };
  std::ranges::stable_sort(all_, [&](const candidate& a, const candidate& b) {
    return group(a) != group(b) ? group(a) < group(b) : group(a) < 2 && is_better(a, b);
  });
}

const candidate* recommendation::best_of(bool learned) const {
  for (const auto& its : all_) {
    if (its.stands() && its.is_learned() == learned) return &its;
  }
  return nullptr;
}

estimate recommendation::advantage() const {
  const candidate* learned = best_of(true);
  const candidate* classical = best_of(false);
  if (learned == nullptr || classical == nullptr) return {};
  return paired_difference(classical->of_each, learned->of_each);
}

/// At one cost errors must differ by more than two standard errors of their difference, trajectory by
/// trajectory; at one error costs must by more than the grid of steps can tell.
const candidate* recommendation::winner() const {
  const candidate* learned = best_of(true);
  const candidate* classical = best_of(false);
  if (learned == nullptr || classical == nullptr) return learned != nullptr ? learned : classical;
  bool differs = false;
  if (command_.budget) {
    const estimate gain = advantage();
    differs = std::abs(gain.mean) > 2.0 * gain.standard_error;
  } else {
    const double ratio = classical->evaluations_per_time / learned->evaluations_per_time;
    constexpr double start_up = 1.01;
    differs = std::max(ratio, 1.0 / ratio) > grid_ratio * start_up;
  }
  if (!differs) return nullptr;
  return is_better(*learned, *classical) ? learned : classical;
}

std::string recommendation::verdict() const {
  const candidate* its = winner();
  if (its != nullptr) return its->is_learned() ? "learned" : "classical";
  return has_result() ? "tie" : "none";
}

std::string recommendation::as_options(const candidate& its) const {
  const std::string where = command_.placement.empty() ? "" : " --placement " + command_.placement;
  return fmt::format("--method {} --step {:.12g}{}", its.source.typed, its.step, where);
}

std::string recommendation::advice() const {
  const candidate* learned = best_of(true);
  const candidate* classical = best_of(false);
  const candidate* best = winner();
  if (!has_result())
    return "No method stays with the reference: take more evaluations, or a shorter horizon.";
  if (learned == nullptr) {
    return fmt::format(
        "A classical method wins: {}. None that was learned stands; there is no scheme to write.",
        as_options(*classical));
  }
  if (classical == nullptr) {
    return fmt::format("Take {} at step {:.12g}: no classical method stands.", learned->source.typed,
                       learned->step);
  }
  const auto factor = [&](const candidate& a, const candidate& b) {
    return command_.budget ? b.error.mean / a.error.mean : b.evaluations_per_time / a.evaluations_per_time;
  };
  const char* what = command_.budget ? "error" : "cost in evaluations";
  const estimate gain = advantage();
  const std::string by = command_.budget
                             ? fmt::format(" (by {:.2e} +- {:.1e})", std::abs(gain.mean), gain.standard_error)
                             : std::string();
  if (best == nullptr) {
    const std::string within =
        command_.budget ? fmt::format("differ by {:.1e} +- {:.1e} only", gain.mean, gain.standard_error)
                        : std::string("cost the same but for the grid of steps");
    return fmt::format("A tie: {} and {} {}. The latter needs no learning: {}.", learned->source.typed,
                       classical->source.typed, within, as_options(*classical));
  }
  if (best == classical) {
    return fmt::format(
        "A classical method wins: {}. Its {} is {:.2g} times smaller than that of {}{}; there is "
        "no scheme to write.",
        as_options(*classical), what, factor(*classical, *learned), learned->source.typed, by);
  }
  std::string text = fmt::format(
      "Take {} at step {:.12g}: its {} is {:.2g} times smaller than that of {}, the best "
      "classical method{}.",
      learned->source.typed, learned->step, what, factor(*learned, *classical), classical->source.typed, by);
  if (!learned->rotates) return text;
  const auto plain =
      std::ranges::find_if(all_, [](const candidate& its) { return its.stands() && !its.rotates; });
  text += " It rotates the quadratic part exactly, and only its soft forces are counted: look at its seconds";
  if (plain != all_.end()) text += fmt::format("; without rotation {} is best", plain->source.typed);
  return text + ".";
}

std::optional<std::string> recommendation::scheme() const {
  const candidate* its = winner();
  if (its == nullptr || !its->is_learned()) return std::nullopt;
  const learn_plan plan =
      plan_for(*its->source.family, its->where, its->step, learning_at(its->step), common_);
  return scheme_text({*its->learned}, *system_, plan);
}

std::string recommendation::quantity() const {
  if (command_.metric == "path") return "path error of " + command_.observable;
  if (command_.metric == "acceptance") return fmt::format("rejection at kT = {:g}", command_.hmc_temperature);
  return command_.metric + " error";
}

json recommendation::document() const {
  json rows = json::array();
  json fits = json::array();
  for (const auto& its : all_) {
    const bool has_error = its.reason.empty();
    rows.push_back({{"method", its.source.typed},
                    {"learned", its.is_learned()},
                    {"order", its.order},
                    {"reversible", its.symmetric},
                    {"rotation", its.rotates},
                    {"evaluations_per_step", its.source.evaluations_per_step},
                    {"step_size", its.step},
                    {"evaluations_per_time", its.evaluations_per_time},
                    {"seconds_per_time", its.seconds_per_time},
                    {"error", its.error.mean},
                    {"standard_error", its.error.standard_error},
                    {"diverged", its.diverged},
                    {"reference_error", its.reference_error ? json(*its.reference_error) : json(nullptr)}});
    if (!has_error) rows.back()["reason"] = its.reason;
    if (!its.learned) continue;
    json fit{{"method", its.source.typed}};
    fit.update(fit_json(its.learned->fit));
    fits.push_back(fit);
  }
  json left_out = json::array();
  for (const auto& [name, reason] : left_out_) left_out.push_back({{"method", name}, {"reason", reason}});
  const auto name_of = [](const candidate* its) {
    return its == nullptr ? json(nullptr) : json(its->source.typed);
  };
  const estimate gain = advantage();
  return {{"system", system_->description()},
          {"starts", system_->starts()},
          {"metric", command_.metric},
          {"observable", command_.metric == "path" ? json(command_.observable) : json(nullptr)},
          {"budget", command_.budget ? json(*command_.budget) : json(nullptr)},
          {"error", command_.error ? json(*command_.error) : json(nullptr)},
          {"horizon", command_.horizon},
          {"trajectories", command_.trajectories},
          {"seed", common_.seed},
          {"verdict", verdict()},
          {"winner", name_of(winner())},
          {"best_learned", name_of(best_of(true))},
          {"best_classical", name_of(best_of(false))},
          {"advantage", gain.mean},
          {"advantage_standard_error", gain.standard_error},
          {"advice", advice()},
          {"rows", rows},
          {"fits", fits},
          {"left_out", left_out},
          {"warnings", warnings_}};
}

std::string recommendation::readable() const {
  std::string text = fmt::format("{}, {} fresh trajectories over {:g}, {}", system_->description(),
                                 command_.trajectories, command_.horizon, quantity());
  text += command_.budget ? fmt::format(", {:g} evaluations per unit time", *command_.budget)
                          : fmt::format(" below {:g}", *command_.error);
  text += fmt::format("\nstarts: {}\n\n", system_->starts());
  table ranking(
      {"method", "order", "step", "evaluations/time", "ns/time", "error", "standard error", "diverged"});
  const auto number = [](const char* format, double x) {
    return std::isfinite(x) ? fmt::format(fmt::runtime(format), x) : std::string("-");
  };
  for (const auto& its : all_) {
    ranking.add({its.source.typed, fmt::format("{}", its.order), number("{:.4g}", its.step),
                 number("{:.1f}", its.evaluations_per_time), number("{:.0f}", 1e9 * its.seconds_per_time),
                 number("{:.2e}", its.error.mean), number("{:.1e}", its.error.standard_error),
                 fmt::format("{}/{}", its.diverged, command_.trajectories)});
  }
  text += ranking.text();
  for (const auto& its : all_) {
    if (!its.reason.empty()) text += fmt::format("{}: {}\n", its.source.typed, its.reason);
  }
  std::map<std::string, std::string> by_reason;
  for (const auto& [name, reason] : left_out_) {
    auto& names = by_reason[reason];
    names += names.empty() ? name : ", " + name;
  }
  for (const auto& [reason, names] : by_reason) text += fmt::format("left out: {}: {}\n", names, reason);
  return text + "\n" + advice() + "\n";
}

}  // namespace nysalt::program
