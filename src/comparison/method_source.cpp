// SPDX-License-Identifier: BSL-1.0
#include "method_source.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "did_you_mean.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/learning/reach.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/method.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

constexpr std::string_view to_learn = "learned:";

void count(method_source& source, const nysalt::word& word) {
  source.word = word;
  source.evaluations_per_step = word.evaluations_per_step;
  source.force_derivatives = word.force_derivatives;
  source.evaluations_to_observe = word.evaluations_to_observe;
}

void take_file(method_source& source, method_file file) {
  source.learned = std::move(file.learned);
  source.fixed = std::move(file.table);
  count(source, source.learned ? source.learned->letters() : source.fixed->letters());
}

bool is_file_name(const std::string& text) {
  std::error_code ignored;
  return text.ends_with(".json") || text.find('/') != std::string::npos ||
         std::filesystem::is_regular_file(text, ignored);
}

}  // namespace

method_source find_method(const std::string& typed, const std::map<std::string, std::string>& held,
                          const std::vector<letter_facts>& of_system) {
  if (of_letters(typed) != typed) {  // reports show the name in every format
    refuse(
        "the name of a method must be UTF-8 without line breaks and other control characters, got '{}'; "
        "rename the file",
        typed);
  }
  method_source source;
  source.typed = typed;
  if (const auto found = held.find(typed); found != held.end()) {
    take_file(source, method_file_in(found->second, typed, of_system));
    return source;
  }
  source.typed = canonical_method(typed);
  std::string text = source.typed;
  if (const auto at = text.rfind('@'); at != std::string::npos && !is_file_name(text)) {
    source.where = placement_named(text.substr(at + 1));
    text.resize(at);
  } else if (at != std::string::npos) {
    for (const auto known : placements) {  // any other @ is part of the file's name
      if (source.typed.substr(at + 1) != to_string(known)) continue;
      source.where = known;
      text = source.typed.substr(0, at);
    }
  }
  for (const auto& known : classical_methods()) {
    if (known.method.name() == text) source.fixed = known.method;
  }
  if (is_word(text)) source.fixed = method_of_word(text, of_system);
  for (const auto& known : adaptive_methods()) {
    if (known.name == text) source.adaptive = &known;
  }
  if (source.fixed) {
    count(source, source.fixed->letters());
  } else if (source.adaptive != nullptr) {
    count(source, source.adaptive->letters);
  } else if (text.starts_with(to_learn)) {
    source.family = text.substr(to_learn.size());
    count(source, family_named(*source.family, of_system).letters);
  } else if (is_file_name(text)) {
    take_file(source, read_method_file(text, of_system));
  } else {
    auto known = method_names_and_aliases();
    for (const auto& name : family_names()) known.push_back(std::string(to_learn) + name);
    constexpr const char* otherwise = "nysalt list shows all; a method may also be a file NAME.json";
    refuse("unknown method '{}': {}", text, did_you_mean(text, known, otherwise));
  }
  return source;
}

std::string objection_to_order(const method_source& source, const prepared_problem& system) {
  const bool needs_quadratic = source.fixed      ? source.fixed->requires_quadratic_kinetic
                               : source.adaptive ? source.adaptive->properties.requires_quadratic_kinetic
                                                 : false;
  if (!needs_quadratic || has_quadratic_kinetic(system.definition().system)) return {};
  return "its order is for K = p^2/2m";
}

void charge(method_source& source, const prepared_problem& system) {
  source.evaluations_per_step += (system.derivative_calls() - 1) * source.force_derivatives;
}

namespace {

/// Of a scheme or a system, by name; null: it has none of that name.
const letter_facts* letter_in(const std::vector<letter_facts>& all, char name) {
  const auto found = std::ranges::find(all, name, &letter_facts::letter);
  return found == all.end() ? nullptr : &*found;
}

/// Refuses a scheme with letters that the system has not, or has otherwise.
void require_letters_of(const method_source& source, const prepared_problem& system) {
  for (const letter_facts& stated : source.learned->own_letters) {
    const char name = stated.letter;
    const auto* own = letter_in(system.letters(), name);
    if (own == nullptr) {
      refuse("{}: the letters of its word {} must be of {}, which has {}, got {} of {}; learn a method there",
             source.typed, source.learned->letters().letters(), system.description(),
             names_of(system.letters()), name, source.learned->system);
    }
    if (as_stated(*own) != stated) {
      refuse(
          "{}: the letter {} of {} must be what it was when the scheme was learned, got another; learn the "
          "scheme again",
          source.typed, name, system.description());
    }
  }
}

/// The same with the letters of the system for those that a file states.
method with_letters_of(const prepared_problem& system, const method& method) {
  if (!method.letters().has_own_letters()) return method;
  return {method.name(), word(method.letters().letters(), system.letters()), method.coefficients(), method};
}

}  // namespace

std::optional<fitted_frequency> frequency_of(const method_source& source, const prepared_problem& system) {
  return source.adaptive == nullptr ? std::nullopt : source.adaptive->frequency(system);
}

bool is_at(const scheme& learned, double step) { return learned.curve.covers(step); }

bool is_of_other_size(const scheme& learned, const prepared_problem& system) {
  return learned.system != system.description() && !learned.kind.empty() && learned.kind == system.kind();
}

std::string out_of_place(const scheme& learned, const prepared_problem& system, double step) {
  std::vector<std::string> reasons;
  if (!is_at(learned, step)) {
    reasons.push_back(message("run at {}, for which it was learned, got {}", learned.steps(), step));
  }
  if (learned.system != system.description() && !is_of_other_size(learned, system)) {
    reasons.push_back(
        fmt::format("run on {}, for which it was learned, got {}", learned.system, system.description()));
  }
  if (learned.system == system.description() && learned.source != source_of_system(system.parameters())) {
    reasons.push_back("run on the source and the parameters of " + learned.system +
                      " for which it was learned, got others");
  }
  if (!learned.usable) reasons.push_back("have a usable fit, got one that is not usable: " + learned.reason);
  return fmt::format("{}", fmt::join(reasons, ", and "));
}

namespace {

/// Between learned steps the stability of the method is not yet known.
method from_scheme(const method_source& source, const prepared_problem& system, double step, bool force) {
  nysalt::method method = with_letters_of(system, source.learned->at(step));
  if (source.learned->is_learned_at(step) || force) return method;
  const judgement& found = system.judged(method, step, 1);
  if (!found.holds()) {
    refuse(
        "{} must hold between the steps for which it was learned, at {}, got: {}; learn it there, or take {}",
        source.typed, step, found.in_words(), switched_on("force"));
  }
  return method;
}

/// Refuses a method of another size that fails the trial at this one; unless forced.
void take_at_size(const method_source& source, const method& method, const prepared_problem& system,
                  double step, bool force, std::vector<std::string>& warnings) {
  const std::string which =
      fmt::format("{}: it was learned at another size, for {}", source.typed, source.learned->system);
  if (force) {
    warnings.push_back(which + fmt::format("; it was not tried at this size ({})", switched_on("force")));
    return;
  }
  system.require_served(method.letters());
  const judgement& found = system.judged(method, step, 1);
  if (!found.holds()) {
    refuse(
        "{} must hold for {}, as it was learned at another size, for {}, got: {}; learn it there, take a "
        "smaller step, or take {}",
        source.typed, system.description(), source.learned->system, found.in_words(), switched_on("force"));
  }
  warnings.push_back(
      fmt::format("{}; for {} it was judged {}", which, system.description(), found.in_words()));
}

method found_at(const method_source& source, const prepared_problem& system, double step, bool force,
                std::vector<std::string>& warnings) {
  if (source.fixed) return *source.fixed;
  if (source.learned) {
    require_letters_of(source, system);
    const std::string why = out_of_place(*source.learned, system, step);
    if (why.empty()) {
      nysalt::method method = from_scheme(source, system, step, force);
      if (is_of_other_size(*source.learned, system))
        take_at_size(source, method, system, step, force, warnings);
      return method;
    }
    if (!force) refuse("{} must {}; learn it there, or take {}", source.typed, why, switched_on("force"));
    warnings.push_back(
        fmt::format("{} must {}; used all the same ({})", source.typed, why, switched_on("force")));
    return from_scheme(source, system, step, force);
  }
  if (source.adaptive != nullptr) {
    const auto frequency = frequency_of(source, system);
    if (!frequency) {
      refuse(
          "{} must run on a system with a highest frequency, got {}, which declares none and shows none "
          "along its motion; give {}, or take another method",
          source.typed, system.description(), spelled("frequency"));
    }
    try {
      return source.adaptive->at(step * frequency->value);
    } catch (const std::invalid_argument& problem) {
      refuse("cannot take {} at the step {}: {}", source.typed, step, problem.what());
    }
  }
  refuse("{} must be learned first: {}", source.typed,
         spelled_learning(*source.family, source.where ? to_string(*source.where) : "", step));
}

constexpr placement usual = placement::symmetric;  // the best of the three for the invariant distribution

method adapted_to_bath(const method_source& source, method method, const prepared_problem& system,
                       std::optional<placement> otherwise, std::vector<std::string>& warnings) {
  const bool has_letters = method.letters().stochastic_letters > 0;
  if (method.letters().is_processed() && source.where)
    refuse("{}: a processed method must have no letters O, got the placement {}; leave the placement away",
           source.typed, to_string(*source.where));
  if (has_letters && source.where)
    refuse("{} must have no letters O for a placement, got {}; leave the placement away", source.typed,
           method.letters().letters());
  if (!system.heat_bath().acts()) {
    if (has_letters || source.where) {
      warnings.push_back(fmt::format("{}: without a bath ({}) its letters O are left out", source.typed,
                                     spelled("friction")));
    }
    return method;
  }
  if (has_letters) return method;
  try {
    return thermostat(method, source.where.value_or(otherwise.value_or(usual)));
  } catch (const std::invalid_argument& problem) {
    refuse("cannot thermostat {}: {}", source.typed, problem.what());
  }
}

}  // namespace

method coefficients_at(const method_source& source, const prepared_problem& system, double step, bool force,
                       std::optional<placement> otherwise, std::vector<std::string>& warnings) {
  nysalt::method method =
      adapted_to_bath(source, found_at(source, system, step, force, warnings), system, otherwise, warnings);
  system.require_served(method.letters());
  system.require_sound_letters(source.typed, method.letters(), step);
  if (const auto frequency = frequency_of(source, system); frequency && system.is_frequency_seen()) {
    const std::string text = fmt::format("methods that are fitted to a frequency take {}; {} gives another",
                                         in_words(*frequency), spelled("frequency"));
    if (std::ranges::count(warnings, text) == 0) warnings.push_back(text);
  }
  return method;
}

std::optional<std::string> warning_of_energies(const method_source& source, const prepared_problem& system,
                                               const trajectories_plan& plan) {
  if (!source.learned || !source.learned->energies) return std::nullopt;
  if (source.learned->system != system.description()) return std::nullopt;
  auto energies = system.values_at_starts(plan, "energy");
  energies.resize(std::min(energies.size(), static_cast<std::size_t>(plan.count)));
  const auto found = count_outside(*source.learned->energies, source.learned->trajectories, energies);
  if (!found.is_serious()) return std::nullopt;
  return fmt::format(
      "{}: {}: its errors may be larger than those that it was learned with; learn it from such starts, or "
      "compare it with other methods on them",
      source.typed, found.report());
}

std::optional<placement> placement_in(const method_source& source, const prepared_problem& system,
                                      std::optional<placement> otherwise) {
  if (!system.heat_bath().acts()) return std::nullopt;
  const placement where = source.where.value_or(otherwise.value_or(usual));
  const nysalt::word word = family_named(*source.family, system.letters()).letters;
  if (word.is_processed()) {
    refuse(
        "{}: a processed method must run without a bath, as a kernel that is learned with a processor gives "
        "modes another temperature; take {}",
        source.typed, source.typed.substr(0, source.typed.rfind('+')));
  }
  if (where == placement::middle && word.length % 2 == 0) {
    refuse("{}: the word must have a central letter to split, got {}; place O at the end, or symmetric",
           source.typed, word.letters());
  }
  return where;
}

int noise_parts(const method& method, const prepared_problem& system) {
  if (system.heat_bath().sigma() == 0.0) return 0;
  return detail::intervals_of_noise(method.letters(), method.coefficients()).parts;
}

std::optional<placement> placement_asked(const std::string& text) {
  if (text.empty()) return std::nullopt;
  return placement_named(text);
}

}  // namespace nysalt::program
