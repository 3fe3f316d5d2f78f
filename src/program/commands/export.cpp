// SPDX-License-Identifier: BSL-1.0
#include <fmt/format.h>

#include "../commands.hpp"
#include "../output.hpp"
#include "comparison/all_ranks.hpp"
#include "comparison/json.hpp"
#include "comparison/method_source.hpp"
#include "comparison/refusal.hpp"
#include "exports/exports.hpp"
#include "nysalt/detail/together.hpp"
#include "nysalt/version.hpp"

namespace nysalt::program {

namespace {

/// What is exported, and what its header says.
exported_method method_of(const export_command& command) {
  const method_source source = find_method(command.method);
  if (source.family) {
    refuse("export: {} must be learned first: nysalt learn --family {} --step STEP --output scheme.json",
           source.typed, *source.family);
  }
  if (source.adaptive != nullptr) {
    refuse(
        "export: {} depends on step and highest frequency, and an exported file has one list of "
        "coefficients: learn a "
        "family at the step, or take a method with fixed coefficients",
        source.typed);
  }
  std::vector<std::string> about;
  if (source.fixed) {
    const tabulated& method = *source.fixed;
    if (command.step) refuse("export: --step is for schemes, and {} is the same at every step", source.typed);
    about.push_back(
        fmt::format("{}: letters {}, order {}.", method.name(), method.letters().letters(), method.order));
    return {method, identifier_of(command.name.empty() ? method.name() : command.name), about};
  }
  const scheme& learned = *source.learned;
  const auto steps = learned.curve.steps();
  if (!command.step && steps.size() > 1) {
    refuse("export: {} was learned at several steps, {}: give one of them or one between them by --step",
           source.typed, learned.steps());
  }
  if (learned.where) {
    refuse(
        "export: {} was learned in a bath, with letters O, and so far only words without a bath are "
        "exported: learn "
        "without a bath, and place the letters O in the host",
        source.typed);
  }
  const double step = command.step.value_or(steps.front());
  if (!(step >= steps.front() * (1.0 - 1e-9) && step <= steps.back() * (1.0 + 1e-9))) {
    refuse("export: --step must be {}, as {} was learned there, got {}", learned.steps(), source.typed, step);
  }
  const tabulated method = learned.at(step);
  about.push_back(fmt::format("{}: letters {}, order {}, learned by nysalt.", learned.family,
                              method.letters().letters(), method.order));
  about.push_back(
      fmt::format("For the system {} at the step {}: at another step or system it promises nothing.",
                  learned.system, step));
  if (!learned.usable) about.push_back(fmt::format("NOT to be used: {}", learned.reason));
  return {method, identifier_of(command.name.empty() ? learned.family : command.name), about};
}

}  // namespace

int export_method(const export_command& command, const common_settings& common) {
  on_first(all_ranks(), [&] {
    const export_host& host = find_export_host(command.host);
    if (!command.output.empty()) require_writable(command.output);
    exported_method exported = method_of(command);
    if (command.displaced) exported = with_displaced_kicks(exported);
    const run_time_word& word = exported.method.letters();
    exported.about.push_back(
        fmt::format("Force evaluations a step, the first and last joined: {}.", word.evaluations_per_step));
    exported.about.push_back(
        fmt::format("Written by nysalt {}; to cite: nysalt cite --methods {}.", version, command.method));
    const std::string text = host.text(exported);
    if (!command.output.empty()) write_result(command.output, text, common);
    if (common.json) {
      print(text_of(json{{"host", host.name},
                         {"name", exported.name},
                         {"letters", word.letters()},
                         {"coefficients", exported.method.coefficients()},
                         {"evaluations_per_step", word.evaluations_per_step},
                         {"output", command.output.empty() ? json() : json(command.output)},
                         {"text", text}}));
    } else if (command.output.empty()) {
      print(text);
    } else {
      print(fmt::format("Written: {}\n", command.output));
    }
  });
  return done;
}

}  // namespace nysalt::program
