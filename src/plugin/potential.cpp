// SPDX-License-Identifier: BSL-1.0
#include "potential.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "comparison/checks.hpp"
#include "comparison/number.hpp"
#include "comparison/refusal.hpp"
#include "formula.hpp"
#include "names.hpp"

namespace nysalt::program {

namespace {

/// As typed: "x", or "q[16]".
std::vector<variable> variables_of(const std::vector<std::string>& typed) {
  std::vector<variable> all;
  std::int64_t first = 0;
  for (const auto& with_blanks : typed) {
    const auto first_letter = std::min(with_blanks.find_first_not_of(' '), with_blanks.size());
    const std::string text =
        with_blanks.substr(first_letter, with_blanks.find_last_not_of(' ') + 1 - first_letter);
    const auto bracket = text.find('[');
    variable next{text.substr(0, bracket), first, 1, bracket != std::string::npos};
    if (next.is_list) {
      if (!text.ends_with(']')) refuse_value("variables", "must be names or name[number], got '{}'", text);
      next.count =
          number_of<std::int64_t>(spelled("variables"), text.substr(bracket + 1, text.size() - bracket - 2));
    }
    if (!is_name(next.name))
      refuse_value("variables", "must be names of letters, digits and _, got '{}'", next.name);
    if (next.count < 1 || next.count > most_coordinates - first) {
      refuse_value("variables", "must be at least 1 and at most {} coordinates", most_coordinates);
    }
    first += next.count;
    all.push_back(next);
  }
  if (all.empty())
    refuse_value("potential", "must come with {}; give the names of its coordinates, joined by commas",
                 spelled("variables"));
  return all;
}

std::vector<double> masses_of(const typed_potential& typed, std::int64_t count) {
  for (const double mass : typed.masses) require_positive("mass", mass);
  const auto given = std::ssize(typed.masses);
  if (given != 0 && given != 1 && given != count) {
    refuse_value("mass", "must be one, or one for each of {} coordinates, got {}", count, given);
  }
  std::vector<double> all(static_cast<std::size_t>(count), given == 1 ? typed.masses.front() : 1.0);
  if (given == count) all = typed.masses;
  return all;
}

std::vector<double> centre_of(const typed_potential& typed, const std::vector<variable>& variables,
                              std::int64_t count) {
  std::vector<double> centre(static_cast<std::size_t>(count), 0.0);
  for (const auto& [name, text] : values_of(typed.around, spelled("around"))) {
    const auto bracket = name.find('[');
    const auto found = std::ranges::find(variables, name.substr(0, bracket), &variable::name);
    const auto require = [&](bool is_coordinate) {
      if (!is_coordinate) refuse("{}: names must be coordinates, got '{}'", spelled("around"), name);
    };
    require(found != variables.end());
    const double value = number_of<double>(spelled("around"), text);
    if (bracket == std::string::npos) {
      std::fill_n(centre.begin() + found->first, found->count, value);
      continue;
    }
    require(found->is_list && name.ends_with(']'));
    const auto i =
        number_of<std::int64_t>(spelled("around"), name.substr(bracket + 1, name.size() - bracket - 2));
    require(i >= 1 && i <= found->count);
    centre[static_cast<std::size_t>(found->first + i - 1)] = value;
  }
  return centre;
}

/// Whether some C++ has a name, between characters that are of no name.
bool has_word(const std::string& code, const std::string& name) {
  const auto is_in_name = [&](std::size_t at) {
    return at < code.size() && is_name("_" + code.substr(at, 1));
  };
  for (auto at = code.find(name); at != std::string::npos; at = code.find(name, at + 1)) {
    if (!is_in_name(at + name.size()) && (at == 0 || !is_in_name(at - 1))) return true;
  }
  return false;
}

std::string listed_numbers(const std::vector<double>& numbers) {
  std::string text;
  for (const double x : numbers) text += fmt::format("{}{}", text.empty() ? "" : ", ", x);
  return text;
}

}  // namespace

std::vector<std::string> coordinate_names(const typed_potential& typed) {
  std::vector<std::string> names;
  for (const variable& one : variables_of(typed.variables)) {
    if (!one.is_list) names.push_back(one.name);
    for (std::int64_t i = 1; one.is_list && i <= one.count; ++i)
      names.push_back(fmt::format("{}[{}]", one.name, i));
  }
  return names;
}

std::vector<std::pair<std::string, std::string>> values_of(const std::vector<std::string>& typed,
                                                           const std::string& option) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& text : typed) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) refuse("{} must be name=value, got '{}'", option, text);
    all.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return all;
}

std::vector<std::pair<std::string, std::string>> parameters_of(const typed_potential& typed) {
  auto all = values_of(typed.parameters, spelled("parameter"));
  for (auto& [name, value] : all) name = in_lower_case(name);
  return all;
}

std::string source_of(const typed_potential& typed) {
  constexpr std::size_t most = 10'000;
  if (typed.text.size() > most) refuse_value("potential", "must be at most {} characters", most);
  const auto variables = variables_of(typed.variables);
  const std::int64_t count = variables.back().first + variables.back().count;
  std::vector<std::string> parameters;
  for (const auto& [name, value] : parameters_of(typed)) {
    if (name == "deviation_q" || name == "deviation_p") continue;
    if (!is_plain_name(name)) {
      refuse_value("parameter",
                   "must have a name of lower-case letters, digits and _, a letter first, got '{}'", name);
    }
    if (is_reserved_name(name))
      refuse_value("parameter", "must have a name that is not one of nysalt's own, got '{}'; choose another",
                   name);
    parameters.push_back(name);
  }
  std::vector<std::string> names = parameters;
  for (const auto& coordinate : variables) names.push_back(coordinate.name);
  for (const auto& name : names) {
    const bool is_taken = is_name_of_grammar(name) || std::ranges::count(names, name) > 1;
    if (is_taken)
      refuse("{} and {} must have different names, other than those of functions, got '{}'; choose another",
             spelled("variables"), spelled("parameter"), name);
  }
  std::string text = typed.text;
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');  // of a file of options
  const std::string code = translated(text, variables, parameters);
  for (const auto& name : parameters) {
    if (has_word(code, "p_" + name)) continue;
    refuse_value("parameter", "must be of the potential, got {}, which is not in it; leave {} away", name,
                 name);
  }
  const auto masses = masses_of(typed, count);
  const auto centre = centre_of(typed, variables, count);

  std::string source =
      "// Written by nysalt of a potential that was given as text.\n#include <nysalt/plugin.hpp>\n\n"
      "#include <array>\n#include <cmath>\n#include <cstdint>\n\nnamespace {\n\n"
      "template <int N, class T>\nT power(const T& x) {\n  if constexpr (N < 0) {\n    return 1.0 / "
      "power<-N>(x);\n"
      "  } else if constexpr (N == 0) {\n    return T(1.0);\n  } else if constexpr (N == 1) {\n    return "
      "x;\n"
      "  } else {\n    const T half = power<N / 2>(x);\n    const T square = half * half;\n"
      "    if constexpr (N % 2 == 0) return square;\n    else return square * x;\n  }\n}\n";
  source += code_of_functions();
  source += fmt::format(
      "\nconstexpr std::array<double, {0}> masses{{{1}}};\nconstexpr std::array<double, {0}> "
      "centre{{{2}}};\n\n}}  // namespace\n\n",
      count, listed_numbers(masses), listed_numbers(centre));
  source += fmt::format("struct given_potential {{\n  static constexpr int dimension = {};\n",
                        count <= 6 ? fmt::format("{}", count) : "Eigen::Dynamic");
  for (const auto& name : parameters) source += fmt::format("  double p_{} = 1.0;\n", name);
  source += "  double deviation_q = 0.1;\n  double deviation_p = 0.1;\n\n";
  source += fmt::format("  Eigen::Index size() const {{ return {}; }}\n", count);
  const bool has_masses = std::ranges::any_of(masses, [](double m) { return m != 1.0; });
  if (has_masses) {
    source +=
        "  double inverse_mass(Eigen::Index i) const { return 1.0 / masses[static_cast<std::size_t>(i)]; }\n";
  }
  source += fmt::format(
      "  template <class T>\n  T potential_energy(const auto& q) const {{\n    return T({});\n  }}\n", code);
  source +=
      "  template <class T>\n  T potential(const nysalt::vector<T, dimension>& q) const {\n"
      "    return potential_energy<T>(q);\n  }\n";
  std::string shown;  // a hole for the value of each parameter
  std::string values;
  for (const auto& name : parameters) {
    shown += fmt::format(", {}={{}}", name);
    values += fmt::format(", p_{}", name);
  }
  const std::string of_variables = fmt::format("; {}", fmt::join(typed.variables, ","));
  const std::string of_masses = has_masses ? fmt::format(", masses {}", listed_numbers(masses)) : "";
  source += fmt::format(
      "  std::string description() const {{\n    return nysalt::sentence(\"given_potential({}{}{})\"{});\n  "
      "}}\n}};\n\n",
      text, of_variables + of_masses, shown, values);
  source += fmt::format("NYSALT_SYSTEM(given_potential, \"V = {}\"", text);
  for (const auto& name : parameters)
    source += fmt::format(",\n  parameter(\"{0}\", &given_potential::p_{0}, \"of V\")", name);
  source +=
      ",\n  parameter(\"deviation_q\", &given_potential::deviation_q, \"of the coordinates of "
      "starts\").at_least(0)"
      ",\n  parameter(\"deviation_p\", &given_potential::deviation_p, \"of the momenta of "
      "starts\").at_least(0)"
      ",\n  starts([](const given_potential& system, double spread) {\n"
      "    nysalt::vector<double, given_potential::dimension> q(system.size());\n    auto p = q;\n"
      "    for (Eigen::Index i = 0; i < system.size(); ++i) {\n"
      "      q[i] = centre[static_cast<std::size_t>(i)];\n      p[i] = 0.0;\n    }\n"
      "    return nysalt::normal_around<given_potential::dimension>({q, p}, system.deviation_q * spread,\n"
      "                                                       system.deviation_p * spread);\n  }));\n";
  return source;
}

}  // namespace nysalt::program
