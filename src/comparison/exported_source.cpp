// SPDX-License-Identifier: BSL-1.0
#include "exported_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "did_you_mean.hpp"
#include "inputs.hpp"
#include "nysalt/method.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

/// The text for a host that the file is a template of.
std::string text_by_template(const std::string& file, const export_source& source) {
  constexpr std::size_t longest = std::size_t{1} << 16U;
  const std::string text = contents_of(file, longest, "a template");
  if (text.size() > longest) refuse("{} must be a template, at most {} bytes long", file, longest);
  return export_by_template(text, file, source.method, source.options);
}

/// At the step that was asked for, or the only one.
double step_of(const method_source& source, const export_request& request) {
  const scheme& learned = *source.learned;
  const auto steps = learned.curve.steps();
  if (!request.step && steps.size() > 1) {
    refuse("export: {} must be given, as {} was learned for {}; give one of these steps or one between them",
           spelled("step"), source.typed, learned.steps());
  }
  const double step = request.step.value_or(steps.front());
  if (!(step >= steps.front() * (1.0 - 1e-9) && step <= steps.back() * (1.0 + 1e-9))) {
    refuse("export: {} must be {}, as {} was learned there, got {}", spelled("step"), learned.steps(),
           source.typed, step);
  }
  return step;
}

export_source plain_source(const method_source& source, const export_request& request) {
  if (source.family) {
    refuse("export: {} must be learned first: {}", source.typed, spelled_learning(*source.family));
  }
  if (source.adaptive != nullptr) {
    refuse(
        "export: coefficients must not depend on step and highest frequency, got {}; learn a "
        "family at the step, or take a method with fixed coefficients",
        source.typed);
  }
  if (source.fixed) {
    if (request.step) {
      refuse("export: {} must come with a scheme, got {}, which is the same at every step; leave {} away",
             spelled("step"), source.typed, spelled("step"));
    }
    return {*source.fixed, {.name = request.name}};
  }
  const scheme& learned = *source.learned;
  const double step = step_of(source, request);
  export_source result{learned.at(step), {.name = request.name.empty() ? learned.family : request.name}};
  auto& about = result.options.about;
  about.push_back(fmt::format("A member of the family {}, learned by nysalt.", learned.family));
  about.push_back(
      fmt::format("For the system {} at the step {}: at another step or system it promises nothing.",
                  learned.system, step));
  if (!learned.kind.empty()) {
    about.push_back(fmt::format(
        "Other sizes of its kind, {}, need a trial run: nysalt run or compare makes one.", learned.kind));
  }
  if (!learned.usable) about.push_back(fmt::format("NOT to be used: {}", learned.reason));
  return result;
}

/// The placement of letters O that the name of the method or --placement asks for.
std::optional<placement> placement_of(const method_source& source, const export_request& request) {
  return source.where ? source.where : placement_asked(request.placement);
}

/// What the works are of that `nysalt cite` names, beside nysalt itself.
std::string cited(const method_source& source) {
  if (source.learned) return ", for the method learned:" + source.learned->family;
  const bool is_known = std::ranges::any_of(
      classical_methods(), [&](const auto& known) { return known.method.name() == source.typed; });
  return is_known ? ", for the method " + source.typed : "";
}

}  // namespace

export_source exported_from(const method_source& source, const export_request& request) {
  export_source result = plain_source(source, request);
  const bool is_of_bath = source.learned && source.learned->where && request.placement.empty();
  const auto where = placement_of(source, request);
  if (where && !is_of_bath) {
    if (result.method.letters().stochastic_letters > 0) {
      refuse("export: {} must have no letters O for a placement, got {}; leave the placement away",
             source.typed, result.method.letters().letters());
    }
    try {
      result.method = thermostat(result.method, *where);
    } catch (const std::invalid_argument& problem) {
      refuse("cannot export {}: {}", source.typed, problem.what());
    }
  }
  for (const letter_facts& own : result.method.letters().own()) {
    refuse(
        "export: {} must have letters that hosts have, got the letter {}, which is code of a system; take a "
        "word of A, B, D and G",
        source.typed, own.letter);
  }
  result.options.displaced = request.displaced;
  result.options.about.push_back("To cite: nysalt cite" + cited(source));
  return result;
}

std::string export_text(const std::string& host, const std::string& template_file,
                        const export_source& source) {
  std::vector<std::string> names;
  for (const auto& one : export_hosts()) names.emplace_back(one.name);
  if (host.empty() == template_file.empty()) {
    refuse("export: {} or {} must be given, and not both, got {}; hosts are {}", spelled("to"),
           spelled("template"), host.empty() ? "neither" : "both", listed(names));
  }
  if (template_file.empty() && std::ranges::find(names, host) == names.end()) {
    refuse("export: {} must be a host that is known, got '{}': {}", spelled("to"), host,
           did_you_mean(host, names, "hosts are " + listed(names)));
  }
  try {
    if (template_file.empty()) return export_to(host, source.method, source.options);
    return text_by_template(template_file, source);
  } catch (const std::invalid_argument& problem) {
    throw refusal(problem.what());
  }
}

}  // namespace nysalt::program
