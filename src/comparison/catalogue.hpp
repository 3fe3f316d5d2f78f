// SPDX-License-Identifier: BSL-1.0
// Names that the program knows.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/learning/problem.hpp"
#include "nysalt/letters.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/method.hpp"
#include "refusal.hpp"

namespace nysalt::program {

class prepared_problem;
struct fitted_frequency;  // prepared_problem.hpp

/// Every family that can be learned.
const std::vector<nysalt::family>& families();
std::vector<std::string> family_names();

/// What names of words begin with, as in word:BAB: methods, and families of what is symmetric.
inline constexpr std::string_view word_prefix = "word:";
inline bool is_word(std::string_view name) { return name.starts_with(word_prefix); }

/// FAMILY, or FAMILY+pPAIRS with a processor, or word:LETTERS, of A, B, R, S and the letters of a system.
/// Throws refusal, listing the names, if there is none of that name, and where the family cannot have a
/// processor, or a word no symmetric coefficients.
nysalt::family family_named(std::string_view name, const std::vector<letter_facts>& of_system = {});
/// With its letters O, where there is a bath.
nysalt::family placed(std::string_view name, std::optional<placement> where,
                      const std::vector<letter_facts>& of_system = {});
/// The member of word:LETTERS that is made of equal steps.
nysalt::method method_of_word(std::string_view name, const std::vector<letter_facts>& of_system);
/// The part of H whose time each slot is, a character each. Throws refusal for a letter that has several
/// coefficients and does not say.
std::string times_of_slots(const word& letters);
/// "t, c", or "no letters of its own".
std::string names_of(const std::vector<letter_facts>& of_system);

/// The key of a family's source in docs/bibliography.bib; empty: not published.
std::string source_of_family(std::string_view name);

/// A member of a family, from its parameters. Throws what is wrong with them, or with the name.
nysalt::method family_member(const std::string& family, const std::vector<double>& parameters,
                             const std::vector<letter_facts>& of_system = {});

/// A classical method whose coefficients are fixed.
struct classical_method {
  nysalt::method method;
  std::string_view source;  // in docs/bibliography.bib
};
const std::vector<classical_method>& classical_methods();

/// Another name of a method, by which other programs or textbooks call it.
struct method_alias {
  std::string_view alias;
  std::string_view name;
};
const std::vector<method_alias>& method_aliases();
/// The method's own name for an alias, with the @PLACEMENT that follows it; any other text as it is.
std::string canonical_method(const std::string& typed);

coordinates coordinates_named(const std::string& name);

/// quick, normal or thorough. Throws refusal for anything else.
effort effort_named(const std::string& name);
placement placement_named(const std::string& name);

/// A method whose coefficients depend on z = step * frequency.
struct adaptive_method {
  std::string name;
  std::string_view source;  // in docs/bibliography.bib
  word letters;
  method_properties properties;
  std::optional<fitted_frequency> (*frequency)(const prepared_problem&);  // nothing where none is known
  std::function<method(double z)> at;  // throws std::invalid_argument where it ends
};
const std::vector<adaptive_method>& adaptive_methods();

/// All names that `--method` takes, beside aliases and files.
std::vector<std::string> method_names();
/// The same and aliases, for suggestions.
std::vector<std::string> method_names_and_aliases();
/// What stands for all of them that apply.
inline constexpr std::string_view every_method = "all";

}  // namespace nysalt::program
