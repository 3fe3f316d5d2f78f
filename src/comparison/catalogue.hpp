// SPDX-License-Identifier: BSL-1.0
// Names that the program knows.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/learning/problem.hpp"
#include "nysalt/losses/metric.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/run_time_family.hpp"
#include "refusal.hpp"

namespace nysalt::program {

class prepared_problem;

/// Every family that can be learned.
const std::vector<run_time_family>& families();
std::vector<std::string> family_names();
/// FAMILY, or FAMILY+pPAIRS with a processor. Throws refusal, listing the names, if there is none of that
/// name, and where the family cannot have a processor.
run_time_family family_named(std::string_view name);
/// With its letters O, where there is a bath.
run_time_family placed(std::string_view name, std::optional<placement> where);

/// The key of a family's source in docs/bibliography.bib; empty: not published.
std::string source_of_family(std::string_view name);

/// A member of a family, from its parameters. Throws what is wrong with them, or with the name.
tabulated family_member(const std::string& family, const std::vector<double>& parameters);

/// A classical method whose coefficients are fixed.
struct classical_method {
  tabulated method;
  std::string_view source;  // in docs/bibliography.bib
};
const std::vector<classical_method>& classical_methods();

coordinates coordinates_named(const std::string& name);

/// quick, normal or thorough. Throws refusal for anything else.
effort effort_named(const std::string& name);
placement placement_named(const std::string& name);

/// A method whose coefficients depend on z = step * frequency.
struct adaptive_method {
  std::string name;
  std::string_view source;  // in docs/bibliography.bib
  run_time_word letters;
  method_properties properties;
  std::optional<double> (*frequency)(const prepared_problem&);  // of a system; nothing where none is declared
  std::function<tabulated(double z)> at;                        // throws std::invalid_argument where it ends
};
const std::vector<adaptive_method>& adaptive_methods();

/// All names that `--method` takes, beside files.
std::vector<std::string> method_names();

}  // namespace nysalt::program
