// SPDX-License-Identifier: BSL-1.0
#include "potential.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "comparison/number.hpp"
#include "comparison/refusal.hpp"
#include "names.hpp"

namespace nysalt::program {

namespace {

constexpr std::array functions{"sqrt", "exp",  "expm1", "log",  "sin",  "cos",
                               "tan",  "atan", "sinh",  "cosh", "tanh", "abs"};

bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_in_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool is_name(std::string_view text) {
  return !text.empty() && begins_name(text.front()) && std::ranges::all_of(text, is_in_name);
}

/// Some coordinates: one, or as many as are numbered from 1 on.
struct variable {
  std::string name;
  std::int64_t first;  // in q
  std::int64_t count;
  bool is_list;
};

constexpr std::int64_t most_coordinates = 100'000;

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
      if (!text.ends_with(']')) refuse("--variables: '{}' is neither a name nor name[number]", text);
      next.count =
          number_of<std::int64_t>("--variables", text.substr(bracket + 1, text.size() - bracket - 2));
    }
    if (!is_name(next.name)) refuse("--variables: '{}' is not a name", next.name);
    if (next.count < 1 || next.count > most_coordinates - first) {
      refuse("--variables must be at least 1 and at most {} coordinates", most_coordinates);
    }
    first += next.count;
    all.push_back(next);
  }
  if (all.empty()) refuse("--potential needs --variables: the names of its coordinates, joined by commas");
  return all;
}

/// A whole number that depends on the counters of sums: text for the source, and its range.
struct index {
  std::string code;
  std::int64_t least;
  std::int64_t most;
};

struct counter_of_sum {
  std::string name;
  std::int64_t first;
  std::int64_t last;
};

/// Reads the text by recursive descent, and writes C++.
class translation {
 public:
  translation(std::string_view text, const std::vector<variable>& variables,
              const std::vector<std::string>& parameters)
      : text_(text), variables_(&variables), parameters_(&parameters) {}

  std::string whole() {
    std::string code = sum();
    skip();
    if (at_ < text_.size()) fail("an operator is expected");
    return code;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const std::string found =
        at_ < text_.size() ? fmt::format("'{}'", std::string(text_.substr(at_, 12))) : "the end of the text";
    refuse("--potential: {}, found {} at character {}", what, found, at_ + 1);
  }
  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool takes(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void require(char c) {
    if (!takes(c)) fail(fmt::format("'{}' is expected", c));
  }
  /// Each level of parentheses is a level of the call stack here, and in the compiler.
  struct level {
    explicit level(translation& of) : depth(&of.depth_) {
      if (++*depth > 100) of.fail("this is nested too deeply");
    }
    ~level() { --*depth; }
    level(const level&) = delete;
    level& operator=(const level&) = delete;
    int* depth;
  };

  std::string sum() {
    const level here(*this);
    std::string code = product();
    for (;;) {
      if (takes('+')) {
        code = "(" + code + " + " + product() + ")";
      } else if (takes('-')) {
        code = "(" + code + " - " + product() + ")";
      } else {
        return code;
      }
    }
  }
  std::string product() {
    std::string code = signed_factor();
    for (;;) {
      if (takes('*')) {
        if (takes('*')) fail("a power is x^2");
        code = "(" + code + " * " + signed_factor() + ")";
      } else if (takes('/')) {
        code = "(" + code + " / " + signed_factor() + ")";
      } else {
        return code;
      }
    }
  }
  std::string signed_factor() {
    const level here(*this);
    if (takes('-')) return "(-" + signed_factor() + ")";
    if (takes('+')) return signed_factor();
    return power();
  }
  /// x^n is repeated multiplication for a whole number n, else x^c for a constant c.
  std::string power() {
    const std::string base = primary();
    if (!takes('^')) return base;
    const auto from = at_;
    const bool depended = depends_;
    depends_ = false;
    const std::string exponent = signed_factor();  // a^b^c is a^(b^c)
    if (depends_) {
      at_ = from;
      fail("an exponent must not depend on the coordinates: write exp(y*log(x))");
    }
    depends_ = depended;
    int n = 0;
    std::string digits;
    for (const char c : exponent) {
      if (c != '(' && c != ')' && c != ' ') digits += c;
    }
    if (digits.ends_with(".0")) digits.resize(digits.size() - 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    const bool is_whole = error == std::errc{} && end == digits.data() + digits.size();
    if (is_whole && -64 <= n && n <= 64) return fmt::format("power<{}>({})", n, base);
    return fmt::format("real_power({}, {})", base, exponent);
  }
  std::string primary() {
    skip();
    if (at_ >= text_.size()) fail("a number, a name or a parenthesis is expected");
    const char c = text_[at_];
    if (takes('(')) {
      std::string code = sum();
      require(')');
      return code;
    }
    if (is_digit(c) || c == '.') return number();
    if (begins_name(c)) return named();
    fail("a number, a name or a parenthesis is expected");
  }
  std::string number() {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) fail("this is not a finite number");
    at_ = static_cast<std::size_t>(end - text_.data());
    if (at_ < text_.size() && is_in_name(text_[at_])) fail("write 2*x, not 2x: an operator is expected");
    std::string code = fmt::format("{}", value);
    if (code.find_first_of(".e") == std::string::npos) code += ".0";
    return code;
  }
  std::string name() {
    skip();
    const auto from = at_;
    while (at_ < text_.size() && is_in_name(text_[at_])) ++at_;
    return std::string(text_.substr(from, at_ - from));
  }
  std::string named() {
    const auto from = at_;
    const std::string known = name();
    if (known == "sum") return sum_over();
    if (std::ranges::find(functions, known) != functions.end()) {
      require('(');
      std::string code = "(" + sum() + ")";
      require(')');
      return "of_" + known + code;
    }
    if (std::ranges::count(*parameters_, known) > 0) return "p_" + known;
    for (const auto& coordinate : *variables_) {
      if (coordinate.name == known) return of(coordinate, from);
    }
    for (const auto& counter : counters_) {
      if (counter.name == known) return "static_cast<double>(i_" + known + ")";
    }
    if (known == "pi") return "nysalt_pi";
    at_ = from;
    fail(fmt::format("'{}' is no function, coordinate (--variables) or parameter (--parameter)", known));
  }
  std::string of(const variable& coordinate, std::size_t from) {
    depends_ = true;
    if (!coordinate.is_list) return fmt::format("q[{}]", coordinate.first);
    if (!takes('[')) {
      at_ = from;
      fail(fmt::format("'{0}' is a list: write {0}[1]", coordinate.name));
    }
    const index which = index_sum();
    require(']');
    if (which.least < 1 || which.most > coordinate.count) {
      at_ = from;
      fail(fmt::format("the coordinates are {0}[1] to {0}[{1}], and this goes from {2} to {3}",
                       coordinate.name, coordinate.count, which.least, which.most));
    }
    return fmt::format("q[{} + {}]", coordinate.first - 1, which.code);
  }
  /// sum(i, first, last, term): the bounds are whole numbers, of counters outside of the sum too.
  std::string sum_over() {
    const level here(*this);
    require('(');
    skip();
    const auto from = at_;
    const std::string counter = name();
    const bool is_free = is_name(counter) && counter != "sum" && counter != "pi" &&
                         std::ranges::find(functions, counter) == functions.end() &&
                         std::ranges::count(*parameters_, counter) == 0 &&
                         std::ranges::count(counters_, counter, &counter_of_sum::name) == 0 &&
                         std::ranges::count(*variables_, counter, &variable::name) == 0;
    if (!is_free) {
      at_ = from;
      fail("sum(i, first, last, term) needs a counter with a name of its own");
    }
    require(',');
    const index first = index_sum();
    require(',');
    const index last = index_sum();
    require(',');
    depends_ = true;  // of the coordinates' type, whatever it sums
    counters_.push_back({counter, first.least, std::max(first.least, last.most)});
    const std::string term = sum();
    counters_.pop_back();
    require(')');
    return fmt::format(
        "[&] {{ T total(0.0); for (std::int64_t i_{0} = {1}; i_{0} <= {2}; ++i_{0}) total = total + {3}; "
        "return total; }}()",
        counter, first.code, last.code, term);
  }
  index index_sum() {
    constexpr std::int64_t far = 1'000'000'000;  // beyond it ranges could overflow
    index total = index_factor();
    for (;;) {
      if (total.least < -far || total.most > far) fail("this index goes too far");
      if (takes('+')) {
        const index more = index_factor();
        total = {fmt::format("({} + {})", total.code, more.code), total.least + more.least,
                 total.most + more.most};
      } else if (takes('-')) {
        const index less = index_factor();
        total = {fmt::format("({} - {})", total.code, less.code), total.least - less.most,
                 total.most - less.least};
      } else {
        return total;
      }
    }
  }
  index index_factor() {
    const level here(*this);
    skip();
    if (takes('(')) {
      index inner = index_sum();
      require(')');
      return inner;
    }
    if (at_ < text_.size() && is_digit(text_[at_])) {
      std::int64_t value = 0;
      const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
      if (error != std::errc{} || value > most_coordinates) fail("this number is too large for an index");
      at_ = static_cast<std::size_t>(end - text_.data());
      return {fmt::format("{}", value), value, value};
    }
    const auto from = at_;
    const std::string known = name();
    for (const auto& counter : counters_) {
      if (counter.name == known) return {"i_" + known, counter.first, counter.last};
    }
    at_ = from;
    fail("an index is made of whole numbers, counters of sums, + and -");
  }

  std::string_view text_;
  const std::vector<variable>* variables_;
  const std::vector<std::string>* parameters_;
  std::vector<counter_of_sum> counters_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool depends_ = false;  // something that was read is a coordinate
};

std::vector<double> masses_of(const typed_potential& typed, std::int64_t count) {
  for (const double mass : typed.masses) {
    if (!(mass > 0.0) || !std::isfinite(mass)) refuse("--mass must be positive and finite, got {}", mass);
  }
  const auto given = std::ssize(typed.masses);
  if (given != 0 && given != 1 && given != count) {
    refuse("--mass must be one, or one for each of {} coordinates, got {}", count, given);
  }
  std::vector<double> all(static_cast<std::size_t>(count), given == 1 ? typed.masses.front() : 1.0);
  if (given == count) all = typed.masses;
  return all;
}

std::vector<double> centre_of(const typed_potential& typed, const std::vector<variable>& variables,
                              std::int64_t count) {
  std::vector<double> centre(static_cast<std::size_t>(count), 0.0);
  for (const auto& [name, text] : values_of(typed.around, "--around")) {
    const auto bracket = name.find('[');
    const auto found = std::ranges::find(variables, name.substr(0, bracket), &variable::name);
    if (found == variables.end()) refuse("--around: '{}' is no coordinate", name);
    const double value = number_of<double>("--around", text);
    if (bracket == std::string::npos) {
      std::fill_n(centre.begin() + found->first, found->count, value);
      continue;
    }
    if (!found->is_list || !name.ends_with(']')) refuse("--around: '{}' is no coordinate", name);
    const auto i = number_of<std::int64_t>("--around", name.substr(bracket + 1, name.size() - bracket - 2));
    if (i < 1 || i > found->count) refuse("--around: '{}' is no coordinate", name);
    centre[static_cast<std::size_t>(found->first + i - 1)] = value;
  }
  return centre;
}

std::string listed_numbers(const std::vector<double>& numbers) {
  std::string text;
  for (const double x : numbers) text += fmt::format("{}{}", text.empty() ? "" : ", ", x);
  return text;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> values_of(const std::vector<std::string>& typed,
                                                           const std::string& option) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& text : typed) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) refuse("{}: '{}' is not name=value", option, text);
    all.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return all;
}

std::string source_of(const typed_potential& typed) {
  constexpr std::size_t most = 10'000;
  if (typed.text.size() > most) refuse("--potential must be at most {} characters", most);
  const auto variables = variables_of(typed.variables);
  const std::int64_t count = variables.back().first + variables.back().count;
  std::vector<std::string> parameters;
  for (const auto& [name, value] : values_of(typed.parameters, "--parameter")) {
    if (name == "deviation_q" || name == "deviation_p") continue;
    if (!is_plain_name(name)) {
      refuse("--parameter: '{}' is not a name of lower-case letters, digits and _", name);
    }
    if (is_reserved_name(name)) refuse("--parameter: the name '{}' is taken: choose another", name);
    parameters.push_back(name);
  }
  std::vector<std::string> names = parameters;
  for (const auto& coordinate : variables) names.push_back(coordinate.name);
  for (const auto& name : names) {
    const bool is_taken = name == "sum" || name == "pi" ||
                          std::ranges::find(functions, name) != functions.end() ||
                          std::ranges::count(names, name) > 1;
    if (is_taken) refuse("the name '{}' is taken: choose another", name);
  }
  const std::string code = translation(typed.text, variables, parameters).whole();
  const auto masses = masses_of(typed, count);
  const auto centre = centre_of(typed, variables, count);

  std::string source =
      "// Written by nysalt of a potential that was given as text.\n#include <nysalt/plugin.hpp>\n\n"
      "#include <array>\n#include <cmath>\n#include <cstdint>\n\nnamespace {\n\n"
      "constexpr double nysalt_pi = 3.14159265358979323846;\n\n"
      "template <int N, class T>\nT power(const T& x) {\n  if constexpr (N < 0) {\n    return 1.0 / "
      "power<-N>(x);\n"
      "  } else if constexpr (N == 0) {\n    return T(1.0);\n  } else if constexpr (N == 1) {\n    return "
      "x;\n"
      "  } else {\n    const T half = power<N / 2>(x);\n    const T square = half * half;\n"
      "    if constexpr (N % 2 == 0) return square;\n    else return square * x;\n  }\n}\n"
      "template <class T>\nT real_power(const T& x, double c) {\n  using std::pow;\n  return pow(x, c);\n}\n";
  for (const char* function : functions) {
    source += fmt::format(
        "template <class T>\nT of_{0}(const T& x) {{\n  using std::{0};\n  return {0}(x);\n}}\n", function);
  }
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
      typed.text, of_variables + of_masses, shown, values);
  source += fmt::format("NYSALT_SYSTEM(given_potential, \"V = {}\"", typed.text);
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
