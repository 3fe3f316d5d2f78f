// SPDX-License-Identifier: BSL-1.0
#include "exported_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "comparison/refusal.hpp"
#include "exports.hpp"
#include "nysalt/version.hpp"

namespace nysalt::program {

namespace {

/// The method, and what the header says of its origin.
exported_method coefficients_of(const method_source& source, const export_request& request) {
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
    if (request.step) refuse("export: --step is for schemes, and {} is the same at every step", source.typed);
    return {method, identifier_of(request.name.empty() ? method.name() : request.name), about};
  }
  const scheme& learned = *source.learned;
  const auto steps = learned.curve.steps();
  if (!request.step && steps.size() > 1) {
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
  const double step = request.step.value_or(steps.front());
  if (!(step >= steps.front() * (1.0 - 1e-9) && step <= steps.back() * (1.0 + 1e-9))) {
    refuse("export: --step must be {}, as {} was learned there, got {}", learned.steps(), source.typed, step);
  }
  const tabulated method = learned.at(step);
  about.push_back(fmt::format("A member of the family {}, learned by nysalt.", learned.family));
  about.push_back(
      fmt::format("For the system {} at the step {}: at another step or system it promises nothing.",
                  learned.system, step));
  if (!learned.usable) about.push_back(fmt::format("NOT to be used: {}", learned.reason));
  return {method, identifier_of(request.name.empty() ? learned.family : request.name), about};
}

/// What `nysalt cite` is asked for.
std::string arguments_of_cite(const method_source& source) {
  if (source.learned) return " --methods learned:" + source.learned->family;
  const bool is_known = std::ranges::any_of(
      classical_methods(), [&](const auto& known) { return known.method.name() == source.typed; });
  return is_known ? " --methods " + source.typed : "";
}

}  // namespace

exported_method exported_from(const method_source& source, const export_request& request) {
  exported_method result = coefficients_of(source, request);
  if (request.displaced) result = with_displaced_kicks(result);
  result.about.insert(result.about.begin(),
                      fmt::format("{}: letters {}, order {}.", result.method.name(),
                                  result.method.letters().letters(), result.method.order));
  result.about.push_back(fmt::format("Force evaluations a step, the first and last joined: {}.",
                                     result.method.letters().evaluations_per_step));
  result.about.push_back(
      fmt::format("Written by nysalt {}; to cite: nysalt cite{}", version, arguments_of_cite(source)));
  return result;
}

}  // namespace nysalt::program
