// SPDX-License-Identifier: BSL-1.0
#include "comparison/stability.hpp"
#include "program/systems.hpp"
#include "report/result_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../commands.hpp"
#include "../output.hpp"
#include "comparison/catalogue.hpp"
#include "comparison/checks.hpp"
#include "comparison/judging.hpp"
#include "comparison/learning.hpp"
#include "comparison/method_source.hpp"
#include "comparison/progress.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "report/stability_picture.hpp"
#include "report/table.hpp"

namespace nysalt::program {

namespace {

struct subject {
  std::string name;
  nysalt::method method;
};

std::vector<letter_facts> letters_of(const prepared_problem* system) {
  return system == nullptr ? std::vector<letter_facts>() : system->letters();
}

subject subject_of(const stability_command& command, const prepared_problem* system, bool force,
                   std::vector<std::string>& warnings) {
  if (command.family && command.method) refuse("--method must come without --family; give one of them");
  if (!command.method) {
    if (!command.family && command.parameters.empty()) {
      refuse("stability: a method must be given; give --method NAME or FILE, or --family with --parameters");
    }
    const std::string family = command.family.value_or("nystrom");
    const nysalt::method method = family_member(family, command.parameters, letters_of(system));
    if (system != nullptr) {
      system->require_served(method.letters());
      system->require_sound_letters(family, method.letters(), *command.step);
    }
    return {family, method};
  }
  if (!command.parameters.empty()) refuse("--parameters must come with --family, got --method");
  const method_source source = find_method(*command.method, {}, letters_of(system));
  if (system != nullptr)
    return {source.typed, coefficients_at(source, *system, *command.step, force, {}, warnings)};
  if (source.learned) return {source.typed, source.learned->at(source.learned->curve.steps().back())};
  if (source.fixed) return {source.typed, *source.fixed};
  if (source.adaptive != nullptr) {
    refuse("{} must have a step and a highest frequency; give --system and --step", source.typed);
  }
  refuse(
      "{} must be learned first: nysalt learn --system SYSTEM --family {} --step STEP --output scheme.json",
      source.typed, *source.family);
}

/// Frequencies of a system, and the margin of a step on them.
struct margin_on_band {
  double low;
  double high;
  double margin;
};

/// The modes that a word which rotates magnifies most in some steps, alone and in a pair.
struct magnified_mode {
  double mode;
  double factor;
  std::int64_t steps;
};
struct growing_pair {
  double first;
  double second;
  double growth;
};

/// The step at which h omega = k pi for some mode, k = 1, 2, ..., that is nearest.
struct resonance_of_mode {
  double mode;
  double multiple;
  double step;
};

/// The findings for machines; nothing of what was not asked for, or is not known.
struct stability_result {
  std::string method;
  std::string letters;
  std::vector<double> coefficients;
  int order;
  int evaluations_per_step;
  std::optional<double> limit{};
  std::optional<double> limit_per_evaluation{};
  std::vector<stability_window> windows{};
  std::vector<double> touching{};
  std::string system{};
  std::optional<double> step{};
  std::optional<nysalt::judgement> judgement{};
  std::optional<rival_judgement> loses_fewest{};
  std::vector<margin_on_band> bands{};
  std::vector<step_range> stable_steps{};
  std::optional<double> linear_step{};
  std::optional<double> safe_step{};
  std::optional<magnified_mode> magnification{};
  std::optional<growing_pair> resonant_pair{};
  std::optional<resonance_of_mode> resonance{};
  std::vector<std::string> warnings{};
  std::string output{};  // the table of the curve
};

/// The findings for machines and as text: what matters most, ranges of z, steps and frequencies, all else,
/// and what only details have.
struct answer {
  stability_result document;
  std::string sentence{};
  table ranges{{"range", "from", "to", "margin"}};
  std::string text{};
  std::string details{};

  void add_range(const char* what, double low, double high, const std::string& margin = "-") {
    ranges.add({what, fmt::format("{:.10g}", low), fmt::format("{:.10g}", high), margin});
  }

  std::string readable(const text_form& form) const {
    std::string shown = wrapped(sentence, form.width);
    if (!ranges.empty()) shown += fmt::format("\n{}", ranges.text(form.width));
    if (!text.empty()) shown += fmt::format("\n{}", wrapped(text, form.width));
    return form.is_verbose ? shown + details : shown;
  }
};

std::string percent(double margin) { return fmt::format("{:.3g} %", 100.0 * margin); }

answer about(const subject& target, const stability_chart& chart) {
  const nysalt::word& word = target.method.letters();
  const int evaluations = word.evaluations_per_step;
  answer result{
      {target.name, word.letters(), target.method.coefficients(), target.method.order, evaluations}};
  result.details =
      fmt::format("{}, order {}, {} evaluations a step\n", word.letters(), target.method.order, evaluations);
  if (word.has_own_letters()) {
    result.sentence =
        target.name +
        " has letters of one's own: it has no windows of z = h omega, and is tried on its system";
    return result;
  }
  if (word.reads_modes) {
    result.sentence =
        target.name +
        " rotates: it is stable on the quadratic part at any step; what soft forces make of that "
        "depends on the system";
    return result;
  }
  const bool from_zero = !chart.windows.empty() && chart.windows.front().low == 0.0;
  const double limit = from_zero ? chart.windows.front().high : 0.0;
  result.document.limit = limit;
  result.document.limit_per_evaluation = limit / evaluations;
  result.document.windows = chart.windows;
  result.document.touching = chart.touching;
  result.sentence = fmt::format("{} is stable up to z = h omega = {:.10g}, {:.10g} for each evaluation",
                                target.name, limit, limit / evaluations);
  for (const auto& [low, high] : chart.windows) result.add_range("stable z = h omega", low, high);
  for (const double z : chart.touching) result.details += fmt::format("where two touch: {:.10g}\n", z);
  return result;
}

/// The judgement in full. It comes first.
void add_judgement(answer& result, const judgement& found) {
  stability_result& document = result.document;
  document.judgement = found;
  result.text = fmt::format("{}\n{}trial: {}\n", result.sentence, result.text, found.report());
  result.sentence = fmt::format("{} at step {:g} for {}: {}", document.method, found.step, document.system,
                                found.in_words());
  if (found.highest_frequency > 0.0) {
    result.text +=
        fmt::format("highest frequency along the motion {:.6g}, z = {:.6g} ({})\n", found.highest_frequency,
                    found.step * found.highest_frequency, found.frequencies);
  } else {
    result.text += fmt::format("{}\n", found.frequencies);
  }
  if (found.margin) result.text += fmt::format("linear margin {}\n", percent(*found.margin));
  const bool is_reason = found.linear_objection == found.reason;
  if (!found.linear_objection.empty() && !is_reason)
    result.text += fmt::format("linear criterion: {}\n", found.linear_objection);
  if (!found.resonance.empty()) result.text += fmt::format("resonance: {}\n", found.resonance);
}

/// Where the step lies among the windows, and which steps are stable and safe.
void add_steps(answer& result, const method& method, const stability_chart& chart,
               const prepared_problem& system, const judgement& found, int threads) {
  stability_result& document = result.document;
  auto bands = system.frequency_bands();
  if (bands.empty() && !(found.highest_frequency > 0.0)) return;  // what the judgement says
  if (bands.empty()) bands.push_back({0.0, found.highest_frequency});
  for (const auto& band : bands) {
    const double margin = stability_margin(chart.windows, found.step * band.low, found.step * band.high);
    document.bands.push_back({band.low, band.high, margin});
    result.add_range("frequencies at this step", band.low, band.high, percent(margin));
  }
  document.stable_steps = stable_steps(chart.windows, bands);
  for (const auto& [low, high] : document.stable_steps) result.add_range("linearly stable steps", low, high);
  const double linear = linear_step(method, chart, found.highest_frequency);
  document.linear_step = only_if(linear > 0.0, linear);
  result.text += fmt::format("{} to the first end, and turn by less than a quarter\n", advice(linear));
  const auto safe = safe_step(method, system, linear, threads);
  document.safe_step = safe;
  if (safe) {
    result.text +=
        fmt::format("safe step {:g}: trials lost nothing there, at {:g}, {:g} % more, and at shorter steps\n",
                    *safe, *safe / (1.0 - tried_margin), 100.0 * (1.0 / (1.0 - tried_margin) - 1.0));
  } else if (system.frequency_bands().empty()) {
    result.text += "no step is called safe: the frequencies of the system have no bound\n";
  } else {
    result.text += "no step is called safe: trials lost trajectories\n";
  }
}

std::optional<resonance_of_mode> nearest_resonance(const std::vector<double>& modes, double step) {
  std::optional<resonance_of_mode> nearest;
  for (const double omega : modes) {
    if (!(omega > 0.0)) continue;
    const double multiple = std::max(1.0, std::round(step * omega / std::numbers::pi));
    const resonance_of_mode one{omega, multiple, multiple * std::numbers::pi / omega};
    if (!nearest || std::abs(one.step - step) < std::abs(nearest->step - step)) nearest = one;
  }
  return nearest;
}

/// Which modes a word that rotates magnifies, and which pair of them grows.
void add_rotation(answer& result, const method& method, const prepared_problem& system, double step) {
  const auto guard = system.guard(method.letters());
  const auto worst = guard.most_magnified(method.letters(), method.coefficients(), step);
  stability_result& document = result.document;
  document.magnification = {worst.frequency, worst.factor, guard.steps()};
  if (worst.frequency > 0.0) {
    result.details += fmt::format("the mode {:.6g} is magnified most, {:.4g}-fold in {} steps\n",
                                  worst.frequency, worst.factor, guard.steps());
  }
  const auto pair = guard.most_resonant(method.letters(), method.coefficients(), step);
  if (pair.growth > 0.0) {
    document.resonant_pair = {pair.first, pair.second, pair.growth};
    result.details +=
        fmt::format("the pair of modes {:.6g} and {:.6g} grows by the factor exp({:.3g}) in {} steps\n",
                    pair.first, pair.second, pair.growth, guard.steps());
  }
  document.resonance = nearest_resonance(guard.modes(), step);
  if (const auto& nearest = document.resonance) {
    result.details += fmt::format("nearest resonance h omega = {:g} pi, of the mode {:.6g}: at step {:.6g}\n",
                                  nearest->multiple, nearest->mode, nearest->step);
  }
}

void write_curve(const stability_command& command, const subject& target, const stability_chart& chart,
                 const std::optional<marked_step>& marked, const common_settings& common) {
  const double highest_z = marked ? marked->step * highest_frequency(marked->bands) : 0.0;
  const auto curve = stability_curve_of(target.method, chart, highest_z);
  write_table(command.output, table_of(curve), common);
  if (!command.plot) return;
  const figure picture{picture_name(command.output), {stability_panel(target.name, curve, chart, marked)}};
  if (const auto warning = write_pictures(picture, folder_of(command.output)); !warning.empty())
    warn(warning);
}

}  // namespace

NYSALT_DESCRIBED(stability_window, low, high)
NYSALT_DESCRIBED(step_range, low, high)
NYSALT_DESCRIBED(margin_on_band, low, high, margin)
NYSALT_DESCRIBED(magnified_mode, mode, factor, steps)
NYSALT_DESCRIBED(growing_pair, first, second, growth)
NYSALT_DESCRIBED(resonance_of_mode, mode, multiple, step)
NYSALT_DESCRIBED(stability_result, method, letters, coefficients, order, evaluations_per_step, limit,
                 limit_per_evaluation, windows, touching, system, step, judgement, loses_fewest, bands,
                 stable_steps, linear_step, safe_step, magnification, resonant_pair, resonance, warnings,
                 output)

json schema_of_stability() { return whole_schema<stability_result>("nysalt stability"); }

int stability(const stability_command& command, const common_settings& common) {
  if (command.step) require_positive("step", *command.step);
  if (command.system && !command.step) {
    refuse("--system must come with --step; give the step at which its frequencies must be stable");
  }
  const auto system = command.system ? make_system(*command.system) : nullptr;
  std::vector<std::string> warnings;
  const subject target = subject_of(command, system.get(), common.force, warnings);
  require_table(command.output, command.plot, false);
  const bool rotates = target.method.letters().reads_modes;
  const bool has_own_letters = target.method.letters().has_own_letters();
  if (has_own_letters && !command.output.empty()) {
    refuse(
        "{}: --output must come without letters of one's own, whose action on oscillators is not known; "
        "leave --output out",
        target.name);
  }
  if (has_own_letters && !system) {
    refuse(
        "{}: letters of one's own must come with their system, on which stability is tried; give --system "
        "and --step",
        target.name);
  }
  if (rotates && !command.output.empty()) {
    refuse("{}: --output must come without rotations, whose trace/2 is cos z; leave --output out",
           target.name);
  }
  const stability_chart chart = rotates || has_own_letters ? stability_chart() : chart_of(target.method);
  answer result = about(target, chart);
  std::optional<marked_step> marked;
  if (system) {
    result.document.system = system->description();
    result.document.step = command.step;
    progress shown;
    warn_of_threads(common);
    // A bath drives the initial states to its stationary distribution.
    prepare_starts(*system, common, shown, warnings);
    shown.part("judging the step");
    const judgement& found = system->judged(target.method, *command.step, common.execution.threads);
    const auto rival = loses_fewest(target.method, *system, found, common.execution.threads);
    shown.clear();
    add_judgement(result, found);
    result.document.loses_fewest = rival;
    if (rival) result.text += in_words(*rival) + "\n";
    if (rotates) add_rotation(result, target.method, *system, *command.step);
    if (!rotates && !has_own_letters) {
      add_steps(result, target.method, chart, *system, found, common.execution.threads);
      marked = {system->description(), *command.step, system->frequency_bands()};
      if (marked->bands.empty()) marked->bands.push_back({0.0, found.highest_frequency});
    }
  }
  result.document.warnings = warnings;
  if (!command.output.empty()) {
    write_curve(command, target, chart, marked, common);
    result.document.output = command.output;
  }
  if (!common.json) {
    for (const auto& warning : warnings) warn(warning);
  }
  std::string text =
      common.json ? text_of(whole_document(result.document)) : result.readable(form_of(common));
  if (!common.json && !command.output.empty()) text += line_of_written(command.output);
  print(text);
  return done;
}

}  // namespace nysalt::program
