// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/linear_stability.hpp"

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

subject subject_of(const stability_command& command, const bundled_system* system) {
  if (command.family && command.method) refuse("--family and --method contradict each other: give one");
  if (command.family) return {*command.family, family_member(*command.family, command.parameters)};
  if (!command.method) refuse("whose stability? Give --method NAME or FILE, or --family with --parameters");
  if (!command.parameters.empty()) refuse("--parameters belong to a --family, not to --method");
  const method_source source = find_method(*command.method);
  if (source.learned) return {source.typed, source.learned->method};
  if (source.is_adaptive() && (system == nullptr || !command.step)) {
    refuse("{} depends on step and highest frequency: give --system and --step", source.typed);
  }
  if (source.fixed) return {source.typed, *source.fixed};
  std::vector<std::string> warnings;
  if (system == nullptr) {
    refuse("{} must be learned first: nysalt learn --family {} --output scheme.json", source.typed,
           *source.family);
  }
  return {source.typed, coefficients_at(source, *system, command.step.value_or(0.0), false, warnings)};
}

}  // namespace

int stability(const stability_command& command, const common_settings& common) {
  if (command.step) require_positive("--step", *command.step);
  if (command.step.has_value() != command.system.has_value()) {
    refuse("--system and --step go together: they say which frequencies must be stable");
  }
  const auto system = command.system ? make_system(*command.system) : nullptr;
  const auto [name, method] = subject_of(command, system.get());
  const auto windows = stability_windows(method);
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
  print(common.json ? text_of(result) : text);
  return done;
}

}  // namespace nysalt::program
