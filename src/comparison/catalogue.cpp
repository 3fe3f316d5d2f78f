// SPDX-License-Identifier: BSL-1.0
#include "catalogue.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

#include "did_you_mean.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/families/gradient_composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/methods/s_aia.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

namespace {
template <class... F>
std::vector<family> families_of() {
  return {family(F{})...};
}
}  // namespace

const std::vector<family>& families() {
  static const auto all = families_of<nystrom, aba<4>, aba<5>, aba<6>, bab<2>, bab<3>, bab<4>, bab<5>, bab<6>,
                                      aba3_free, aba4_free, aba6_free, bab6_free, fg_chin, fg4, fd_chin,
                                      r_aba<2>, r_aba<4>, r_aba<6>, r_fg4>();
  return all;
}

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const auto& family : families()) names.push_back(family.name);
  return names;
}

namespace {

/// The number of pairs that FAMILY+pPAIRS asks for; nothing if the text is no whole number.
std::optional<int> pairs_in(std::string_view digits) {
  int pairs = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), pairs);
  if (problem != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return pairs;
}

/// Throws refusal for a letter that has no place in word:LETTERS.
void require_letters(std::string_view name, std::string_view letters,
                     const std::vector<letter_facts>& known) {
  for (const char letter : letters) {
    if (std::string_view("ABRS").find(letter) != std::string_view::npos) continue;
    if (std::ranges::any_of(known, [&](const auto& one) { return one.letter == letter; })) continue;
    const bool is_of_tables = std::string_view("OGHD|").find(letter) != std::string_view::npos;
    refuse("{}: each letter must be A, B, R, S or one that the system declares, here {}, got {}; {}", name,
           known.empty() ? "none" : names_of(known), letter,
           is_of_tables ? "write a table to use it" : "take one of those");
  }
}

}  // namespace

std::string names_of(const std::vector<letter_facts>& of_system) {
  std::vector<std::string> names;
  for (const auto& one : of_system) names.emplace_back(1, one.letter);
  return names.empty() ? "no letters of its own" : "the letters " + listed(names);
}

std::string times_of_slots(const word& letters) {
  std::string result;
  for (std::size_t i = 0; i < letters.length; ++i) {
    const letter_facts& one = letters.facts(i);
    if (one.times.size != one.slots) {
      refuse(
          "the word {}: the letter {} must state of which parts of H its {} coefficients are the times; add "
          "a member `times`, a character for each",
          letters.letters(), one.letter, one.slots);
    }
    result += one.times.view();
  }
  return result;
}

namespace {
family word_named(std::string_view name, const std::vector<letter_facts>& of_system) {
  const std::string letters(name.substr(word_prefix.size()));
  require_letters(name, letters, of_system);
  constexpr std::size_t most = 64;  // letters: their coefficients are learned
  if (letters.size() > most) {
    refuse("{}: a word must have at most {} letters, got {}", name, most, letters.size());
  }
  try {
    const word all(letters, of_system);
    return symmetric_word(std::string(name), all, times_of_slots(all));
  } catch (const std::invalid_argument& problem) {
    const std::string_view why = problem.what();
    if (why.starts_with(name)) refuse("{}", why);
    refuse("cannot take {}: {}", name, why);
  }
}
}  // namespace

method method_of_word(std::string_view name, const std::vector<letter_facts>& of_system) {
  const auto family = word_named(name, of_system);
  const Eigen::VectorXd& theta = family.starts.front().theta;
  return member(family, {theta.begin(), theta.end()});
}

family family_named(std::string_view name, const std::vector<letter_facts>& of_system) {
  if (is_word(name)) return word_named(name, of_system);
  const auto mark = name.rfind("+p");
  const std::string_view kernel = name.substr(0, mark);
  const auto known = std::ranges::find(families(), kernel, &family::name);
  if (known == families().end()) {
    const char* more = mark == std::string_view::npos ? "" : "; one processor may follow, as in fg4+p3";
    refuse("unknown family '{}': {}{}", name, did_you_mean(kernel, family_names()), more);
  }
  if (mark == std::string_view::npos) return *known;
  const auto pairs = pairs_in(name.substr(mark + 2));
  if (!pairs) refuse("unknown family '{}': a processor is written FAMILY+pPAIRS, as in fg4+p3", name);
  try {
    return processed(*known, *pairs);
  } catch (const std::invalid_argument& problem) {
    refuse("{}", problem.what());
  }
}

family placed(std::string_view name, std::optional<placement> where,
              const std::vector<letter_facts>& of_system) {
  const auto plain = family_named(name, of_system);
  return where ? thermostatted(plain, *where) : plain;
}

std::string source_of_family(std::string_view name) {
  return is_word(name) ? std::string() : family_named(name).source;
}

method family_member(const std::string& name, const std::vector<double>& parameters,
                     const std::vector<letter_facts>& of_system) {
  const auto family = family_named(name, of_system);
  if (std::ssize(parameters) != family.parameters()) {
    refuse("the family {} must have {} parameters ({}), got {}", name, family.parameters(),
           listed(family.parameter_names), parameters.size());
  }
  return member(family, parameters);
}

const std::vector<classical_method>& classical_methods() {
  static const auto all = [] {
    std::vector<classical_method> rows;
    for (const auto& row : detail::classical_table) rows.push_back({detail::as_data(row), row.source});
    for (const auto& row : detail::processed_table) rows.push_back({detail::as_data(row), row.source});
    return rows;
  }();
  return all;
}

const std::vector<method_alias>& method_aliases() {
  static const std::vector<method_alias> all{
      {"velocity_verlet", "verlet"}, {"leapfrog", "verlet"},
      {"stormer_verlet", "verlet"},  {"position_verlet", "verlet_aba"},  // drift, kick, drift
      {"yoshida4", "forest_ruth"},  // three steps of verlet_aba [forest_ruth_1990]
      {"omf4", "omelyan5v"},        // of lattice field theory
  };
  return all;
}

std::string canonical_method(const std::string& typed) {
  const auto end = std::min(typed.rfind('@'), typed.size());
  const auto found =
      std::ranges::find(method_aliases(), std::string_view(typed).substr(0, end), &method_alias::alias);
  return found == method_aliases().end() ? typed : std::string(found->name) + typed.substr(end);
}

namespace {

std::optional<fitted_frequency> to_fit(const prepared_problem& system) { return system.frequency_to_fit(); }
std::optional<fitted_frequency> to_cover(const prepared_problem& system) {
  return system.frequency_to_cover();
}

template <class M>
adaptive_method adaptive(const char* name) {
  return {name, M::source, M::letters_of_all, M::promises, to_cover, [](double z) { return M(z); }};
}

adaptive_method fitted(const family& family, const method& classical) {
  return {"phase_fitted_" + classical.name(),
          detail::phase_fitted_source,
          classical.letters(),
          {classical.order, true, classical.requires_quadratic_kinetic || family.requires_quadratic_kinetic},
          to_fit,
          [=](double z) { return phase_fitted(family, classical, z); }};
}

}  // namespace

const std::vector<adaptive_method>& adaptive_methods() {
  static const std::vector<adaptive_method> all{
      adaptive<s_aia2>("s_aia2"),     adaptive<s_aia3>("s_aia3"),    fitted(fg_chin(), chin4a()),
      fitted(fg4(), omelyan_fg4()),   fitted(aba<4>(), pefrl()),     fitted(bab<4>(), vefrl()),
      fitted(aba<5>(), mclachlan5()), fitted(bab<5>(), omelyan5v()), fitted(bab<6>(), srkn6b()),
  };
  return all;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& known : classical_methods()) names.push_back(known.method.name());
  for (const auto& known : adaptive_methods()) names.push_back(known.name);
  return names;
}

std::vector<std::string> method_names_and_aliases() {
  auto names = method_names();
  for (const auto& [alias, name] : method_aliases()) names.emplace_back(alias);
  return names;
}

placement placement_named(const std::string& name) {
  for (const auto known : placements) {
    if (to_string(known) == name) return known;
  }
  refuse("unknown placement '{}': it is one of end, symmetric, middle", name);
}

coordinates coordinates_named(const std::string& name) {
  for (const auto known : {coordinates::qp, coordinates::modes, coordinates::energy}) {
    if (to_string(known) == name) return known;
  }
  refuse("unknown coordinates '{}': they are one of qp, modes, energy", name);
}

effort effort_named(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, effort>, 3> all{
      {{"quick", effort::quick}, {"normal", effort::normal}, {"thorough", effort::thorough}}};
  for (const auto& [known, value] : all) {
    if (known == name) return value;
  }
  refuse("unknown effort '{}': it is one of quick, normal, thorough", name);
}

}  // namespace nysalt::program
