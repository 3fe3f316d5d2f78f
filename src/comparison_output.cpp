// SPDX-License-Identifier: BSL-1.0
// What a comparison found, for machines and for people.
#include <algorithm>
#include <cmath>

#include "comparison.hpp"
#include "output.hpp"
#include "refusal.hpp"

namespace nysalt::program {

std::string comparison::quantity() const {
  if (command_.metric == "path") return "path error of " + command_.observable;
  if (command_.metric == "distribution") return "total variation of " + command_.observable;
  if (command_.metric == "acf") return "acf error of " + command_.observable;
  if (is_acceptance()) return fmt::format("acceptance at kT = {:g}", command_.hmc_temperature);
  return command_.metric + " error";
}

std::vector<work_precision_row> comparison::work_precision_rows() const {
  std::vector<work_precision_row> result;
  for (const auto& its : rows_) {
    result.push_back({its.method, its.nominal, its.evaluations_per_time, its.seconds_per_time, its.error,
                      its.diverged, command_.trajectories, its.floor});
  }
  return result;
}

/// Each learned method beside the best of the others at its cost; empty if that is not the question.
std::string comparison::at_equal_cost(bool markdown) const {
  if (!command_.equal_cost) return {};
  const auto is_learned = [&](const row& its) { return families_.contains(its.method); };
  const std::string value = value_name();
  table result({"at equal cost", "step", value, "best of the others", "its " + value,
                is_acceptance() ? "its rejections / learned" : "its error / learned"});
  bool any = false;
  for (const auto& its : rows_) {
    if (!is_learned(its)) continue;
    const row* best = nullptr;
    for (const auto& other : rows_) {
      const bool stays = other.diverged == 0 && !std::isnan(other.error.mean);
      if (is_learned(other) || other.nominal != its.nominal || !stays) continue;
      if (best == nullptr || is_better(other, *best)) best = &other;
    }
    if (best == nullptr) continue;
    any = true;
    const auto number = [](const char* format, double x) {
      return std::isfinite(x) ? fmt::format(fmt::runtime(format), x) : std::string("-");
    };
    const char* format = is_acceptance() ? "{:.4f}" : "{:.2e}";
    const double gain = is_acceptance() ? (1.0 - best->error.mean) / (1.0 - its.error.mean)
                                        : best->error.mean / its.error.mean;
    result.add({its.method, number("{:g}", its.nominal), number(format, its.error.mean), best->method,
                number(format, best->error.mean), number("{:.2g}", gain)});
  }
  return !any ? std::string() : markdown ? result.markdown() : result.text();
}

json comparison::document() const {
  const bool has_observable = command_.metric == "path" || is_statistical();
  json rows = json::array();
  for (const auto& its : rows_) {
    rows.push_back({{"method", its.method},
                    {"step", its.nominal},
                    {"step_size", its.step},
                    {"evaluations_per_time", its.evaluations_per_time},
                    {"seconds_per_time", its.seconds_per_time},
                    {value_name(), its.error.mean},
                    {"standard_error", its.error.standard_error},
                    {"diverged", its.diverged},
                    {"reference_error", its.reference_error ? json(*its.reference_error) : json(nullptr)}});
    if (!its.reason.empty()) rows.back()["reason"] = its.reason;
    if (its.floor) rows.back()["floor"] = *its.floor;
    if (!its.statistics) continue;
    const auto& found = *its.statistics;
    rows.back()["mean"] = found.mean.mean;
    rows.back()["mean_standard_error"] = found.mean.standard_error;
    rows.back()["effective_sample_size"] = found.effective_sample_size;
    if (!found.histogram) continue;
    rows.back()["kinetic_temperature"] = found.kinetic_temperature.mean;
    rows.back()["half_step_kinetic_temperature"] = found.half_step_kinetic_temperature.mean;
  }
  json result{{"system", system_->description()},
              {"starts", system_->starts()},
              {"metric", command_.metric},
              {"observable", has_observable ? json(command_.observable) : json(nullptr)},
              {"horizon", command_.horizon},
              {"trajectories", command_.trajectories},
              {"equal_cost", command_.equal_cost},
              {"seed", common_.seed},
              {"references", references_},
              {"rows", rows},
              {"fits", fits_},
              {"warnings", warnings_}};
  if (bins_) result["histogram"] = {{"low", bins_->low}, {"high", bins_->high}, {"bins", bins_->count}};
  if (is_acceptance()) result["hmc_temperature"] = command_.hmc_temperature;
  if (command_.metric == "acf") result["longest_lag"] = command_.longest_lag;
  return result;
}

std::string comparison::readable() const {
  std::string text = fmt::format("{}, {} trajectories over {:g}, {}", system_->description(),
                                 command_.trajectories, command_.horizon, quantity());
  text += fmt::format("\nstarts: {}", system_->starts());
  for (const auto& used : references_) {
    text += fmt::format("\nreference at {:g}: {}, {} {:.1e}", used["step_size"].get<double>(),
                        used["reference"].get<std::string>(), is_statistical() ? "floor" : "own error",
                        used["error"].get<double>());
  }
  if (command_.equal_cost) text += "\nsteps are per force evaluation: equal steps, equal cost";
  text += "\n\n" + work_precision_table(work_precision_rows(), value_name()).text();
  for (const auto& its : rows_) {
    if (!its.reason.empty())
      text += fmt::format("{} at step {:g}: {}\n", its.method, its.nominal, its.reason);
  }
  if (const std::string beside = at_equal_cost(false); !beside.empty()) text += "\n" + beside;
  return text;
}

void comparison::write(const std::filesystem::path& folder) const {
  const auto rows = work_precision_rows();
  make_folder(folder);
  write_result(folder / "table.md",
               work_precision_table(rows, value_name()).markdown() + "\n" + at_equal_cost(true), common_);
  std::vector<std::string> columns{"method",           "step",       "step_size",      "evaluations_per_time",
                                   "seconds_per_time", value_name(), "standard_error", "diverged"};
  if (is_statistical()) columns.emplace_back("floor");
  table all(columns);
  for (const auto& its : rows_) {
    const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{}", x) : std::string(); };
    std::vector<std::string> cells{its.method,
                                   number(its.nominal),
                                   number(its.step),
                                   number(its.evaluations_per_time),
                                   number(its.seconds_per_time),
                                   number(its.error.mean),
                                   number(its.error.standard_error),
                                   fmt::format("{}", its.diverged)};
    if (is_statistical()) cells.push_back(its.floor ? number(*its.floor) : std::string());
    all.add(cells);
  }
  write_result(folder / "rows.csv", all.csv(), common_);
  const auto learned =
      std::ranges::find_if(rows_, [&](const row& its) { return families_.contains(its.method); });
  const std::string emphasised = learned == rows_.end() ? "" : learned->method;
  figure evaluations{value_name() + "_against_evaluations",
                     {work_precision_panel(rows, emphasised, "force evaluations per unit time",
                                           &work_precision_row::evaluations_per_time)}};
  figure seconds{value_name() + "_against_seconds",
                 {work_precision_panel(rows, emphasised, "seconds per unit time",
                                       &work_precision_row::seconds_per_time)}};
  evaluations.panels[0].y_label = seconds.panels[0].y_label = quantity();
  evaluations.panels[0].linear_y = seconds.panels[0].linear_y = is_acceptance();
  for (const auto& picture : {evaluations, seconds}) write_pictures(picture, folder, common_);
  for (const auto& picture : pictures_of_statistics()) write_pictures(picture, folder, common_);
}

}  // namespace nysalt::program
