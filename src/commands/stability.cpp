// SPDX-License-Identifier: BSL-1.0
#include "../stability.hpp"
#include "../catalogue.hpp"
#include "../checks.hpp"
#include "../commands.hpp"
#include "../method_source.hpp"
#include "../output.hpp"

namespace nysalt::program {

namespace {

struct subject {
  std::string name;
  tabulated method;
};

subject subject_of(const stability_command& command, const bundled_system* system, bool force,
                   std::vector<std::string>& warnings) {
  if (command.family && command.method) refuse("--family and --method contradict each other: give one");
  if (!command.method) {
    if (!command.family && command.parameters.empty()) {
      refuse("whose stability? Give --method NAME or FILE, or --family with --parameters");
    }
    const std::string family = command.family.value_or("nystrom");
    return {family, family_member(family, command.parameters)};
  }
  if (!command.parameters.empty()) refuse("--parameters belong to a --family, not to --method");
  const method_source source = find_method(*command.method);
  if (system != nullptr)
    return {source.typed, coefficients_at(source, *system, *command.step, force, {}, warnings)};
  if (source.learned) return {source.typed, source.learned->at(source.learned->curve.steps().back())};
  if (source.fixed) return {source.typed, *source.fixed};
  if (source.is_adaptive()) {
    refuse("{} depends on step and highest frequency: give --step, and --system if it is not fpu",
           source.typed);
  }
  refuse("{} must be learned first: nysalt learn --family {} --step STEP --output scheme.json", source.typed,
         *source.family);
}

}  // namespace

int stability(const stability_command& command, const common_settings& common) {
  if (command.step) require_positive("--step", *command.step);
  if (command.system && !command.step) {
    refuse("--system needs --step: together they say which frequencies must be stable");
  }
  const auto system = command.system ? make_system(*command.system) : nullptr;
  if (system && system->frequency_bands().empty()) {
    refuse("{} declares no frequencies to be stable for: ask without --system", system->description());
  }
  std::vector<std::string> warnings;
  const auto [name, method] = subject_of(command, system.get(), common.force, warnings);
  if (has_rotation(method.letters())) {
    refuse(
        "{} rotates: it is exact on the quadratic part at any step, and what soft forces make of that "
        "depends on "
        "the system; learn and recommend guard against it",
        name);
  }
  const auto windows = stability_of(method);
  const bool from_zero = !windows.empty() && windows.front().low == 0.0;
  const double limit = from_zero ? windows.front().high : 0.0;
  const int evaluations = method.letters().evaluations_per_step;
  json result{{"method", name},
              {"letters", method.letters().letters()},
              {"coefficients", method.coefficients()},
              {"order", method.order},
              {"evaluations_per_step", evaluations},
              {"limit", limit},
              {"limit_per_evaluation", limit / evaluations},
              {"windows", json::array()}};
  for (const auto& [low, high] : windows) result["windows"].push_back({low, high});
  std::string text = fmt::format("{}: {}, order {}, {} evaluations a step\n", name,
                                 method.letters().letters(), method.order, evaluations);
  text += fmt::format("stable up to z = h omega = {:.10g}, {:.10g} for each evaluation\n", limit,
                      limit / evaluations);
  for (const auto& [low, high] : windows) text += fmt::format("  window {:.10g} .. {:.10g}\n", low, high);
  if (system) {
    json bands = json::array();
    for (const auto& [low, high] : system->frequency_bands()) {
      const bool stable = is_stable(windows, *command.step * low, *command.step * high);
      bands.push_back({{"low", low}, {"high", high}, {"stable", stable}});
      text += fmt::format("  frequencies {:g} .. {:g} of {} at step {:g}: {}\n", low, high,
                          system->description(), *command.step, stable ? "stable" : "NOT stable");
    }
    result["system"] = system->description();
    result["step"] = *command.step;
    result["bands"] = bands;
  }
  if (common.json) {
    if (system) result["warnings"] = warnings;
  } else {
    for (const auto& warning : warnings) warn(warning);
  }
  print(common.json ? text_of(result) : text);
  return done;
}

}  // namespace nysalt::program
