// SPDX-License-Identifier: BSL-1.0
#include "formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "comparison/did_you_mean.hpp"
#include "comparison/number.hpp"
#include "comparison/refusal.hpp"
#include "names.hpp"

namespace nysalt::program {

namespace {

struct function {
  std::string_view name;
  std::string_view code;  // the function of C++ that it is
  std::size_t arguments;  // of min and max at least as many
};
constexpr auto functions = std::to_array<function>({{"sqrt", "sqrt", 1},
                                                    {"cbrt", "cbrt", 1},
                                                    {"exp", "exp", 1},
                                                    {"expm1", "expm1", 1},
                                                    {"log", "log", 1},
                                                    {"pow", "pow", 2},
                                                    {"sin", "sin", 1},
                                                    {"cos", "cos", 1},
                                                    {"tan", "tan", 1},
                                                    {"asin", "asin", 1},
                                                    {"acos", "acos", 1},
                                                    {"atan", "atan", 1},
                                                    {"atan2", "atan2", 2},
                                                    {"sinh", "sinh", 1},
                                                    {"cosh", "cosh", 1},
                                                    {"tanh", "tanh", 1},
                                                    {"erf", "erf", 1},
                                                    {"hypot", "hypot", 2},
                                                    {"abs", "abs", 1},
                                                    {"sign", "sign", 1},
                                                    {"floor", "floor", 1},
                                                    {"step", "heaviside", 1},
                                                    {"heaviside", "heaviside", 1},
                                                    {"mod", "mod", 2},
                                                    {"min", "min", 2},
                                                    {"max", "max", 2}});

struct constant {
  std::string_view name;
  std::string_view value;
};
constexpr std::array constants{constant{"pi", "3.14159265358979323846"},
                               constant{"e", "2.71828182845904523536"}};

/// What other languages call functions that are here by another name.
constexpr std::array<std::pair<std::string_view, std::string_view>, 15> foreign{{{"ln", "log"},
                                                                                 {"arcsin", "asin"},
                                                                                 {"arccos", "acos"},
                                                                                 {"arctan", "atan"},
                                                                                 {"arctan2", "atan2"},
                                                                                 {"fabs", "abs"},
                                                                                 {"fmin", "min"},
                                                                                 {"fmax", "max"},
                                                                                 {"fmod", "mod"},
                                                                                 {"power", "pow"},
                                                                                 {"sgn", "sign"},
                                                                                 {"signum", "sign"},
                                                                                 {"theta", "step"},
                                                                                 {"minimum", "min"},
                                                                                 {"maximum", "max"}}};

const function* function_named(std::string_view name) {
  const auto found = std::ranges::find(functions, name, &function::name);
  return found == functions.end() ? nullptr : &*found;
}

bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_in_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

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
    if (at_ < text_.size()) wrong("an operator", "follow");
    return code;
  }

 private:
  /// What must be at this place, and what to do where that does not say it.
  [[noreturn]] void wrong(const std::string& what, const std::string& condition,
                          const std::string& remedy = {}) const {
    const std::string found =
        at_ < text_.size() ? fmt::format("'{}'", std::string(text_.substr(at_, 12))) : "the end of the text";
    refuse("{}: {} must {}, got {} at character {}{}{}", spelled("potential"), what, condition, found,
           at_ + 1, remedy.empty() ? "" : "; ", remedy);
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
    if (!takes(c)) wrong(fmt::format("'{}'", c), "follow");
  }
  /// Each level of parentheses is a level of the call stack here, and in the compiler.
  struct level {
    explicit level(translation& of) : depth(&of.depth_) {
      if (++*depth > 100) of.wrong("the text", "be nested less deeply");
    }
    ~level() { --*depth; }
    level(const level&) = delete;
    level& operator=(const level&) = delete;
    int* depth;
  };

  std::string sum() {
    const level here(*this);
    std::string code = product();
    std::size_t operators = 0;
    for (;; ++operators) {
      if (takes('+')) {
        code.append(" + ").append(product()).append(")");
      } else if (takes('-')) {
        code.append(" - ").append(product()).append(")");
      } else {
        return std::string(operators, '(') + code;
      }
    }
  }
  std::string product() {
    std::string code = signed_factor();
    std::size_t operators = 0;
    for (;; ++operators) {
      if (takes('*')) {
        if (takes('*')) wrong("a power", "be written as x^2");
        code.append(" * ").append(signed_factor()).append(")");
      } else if (takes('/')) {
        code.append(" / ").append(signed_factor()).append(")");
      } else {
        return std::string(operators, '(') + code;
      }
    }
  }
  std::string signed_factor() {
    const level here(*this);
    if (takes('-')) return "(-" + signed_factor() + ")";
    if (takes('+')) return signed_factor();
    return power();
  }
  /// x^n is repeated multiplication for a whole number n.
  std::string power() {
    std::string base = primary();
    if (!takes('^')) return base;
    const std::string exponent = signed_factor();  // a^b^c is a^(b^c)
    int n = 0;
    std::string digits;
    for (const char c : exponent) {
      if (c != '(' && c != ')' && c != ' ') digits += c;
    }
    if (digits.ends_with(".0")) digits.resize(digits.size() - 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    const bool is_whole = error == std::errc{} && end == digits.data() + digits.size();
    if (is_whole && -64 <= n && n <= 64) return fmt::format("power<{}>({})", n, base);
    return fmt::format("of_pow({}, {})", base, exponent);
  }
  std::string primary() {
    skip();
    if (at_ >= text_.size()) wrong("a number, a name or a parenthesis", "follow");
    const char c = text_[at_];
    if (takes('(')) {
      std::string code = sum();
      require(')');
      return code;
    }
    if (is_digit(c) || c == '.') return number();
    if (begins_name(c)) return named();
    wrong("a number, a name or a parenthesis", "follow");
  }
  std::string number() {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) wrong("a number", "be finite");
    at_ = static_cast<std::size_t>(end - text_.data());
    if (at_ < text_.size() && is_in_name(text_[at_]))
      wrong("an operator", "follow a number", "write 2*x, not 2x");
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
    const std::string typed = name();
    std::string code = code_of(typed, from);
    // In upper case it may stand for one in lower case.
    if (code.empty()) code = code_of(in_lower_case(typed), from);
    if (!code.empty()) return code;
    at_ = from;
    wrong(fmt::format("'{}'", typed),
          fmt::format("be a function, a coordinate ({}) or a parameter ({})", spelled("variables"),
                      spelled("parameter")),
          known_names(typed));
  }
  /// Of what has exactly that name; empty if nothing has.
  std::string code_of(const std::string& known, std::size_t from) {
    if (known == "sum") return sum_over();
    if (const auto* found = function_named(known)) return call_of(*found);
    if (std::ranges::count(*parameters_, known) > 0) return "p_" + known;
    for (const auto& coordinate : *variables_) {
      if (coordinate.name == known) return of(coordinate, from);
    }
    for (const auto& counter : counters_) {
      if (counter.name == known) return "static_cast<double>(i_" + known + ")";
    }
    const auto found = std::ranges::find(constants, known, &constant::name);
    return found == constants.end() ? "" : std::string(found->value);
  }
  std::string call_of(const function& called) {
    require('(');
    std::string code = sum();
    std::size_t arguments = 1;
    const bool takes_more = called.name == "min" || called.name == "max";
    while (takes(',')) {
      const std::string next = sum();
      code = ++arguments > 2 ? fmt::format("of_{}({}), {}", called.code, code, next)
                             : fmt::format("{}, {}", code, next);
      if (arguments > called.arguments && !takes_more) break;
    }
    if (arguments < called.arguments || (arguments > called.arguments && !takes_more)) {
      wrong(fmt::format("the function {}", called.name),
            fmt::format("have {} argument{}{}", called.arguments, called.arguments == 1 ? "" : "s",
                        takes_more ? " or more" : ""));
    }
    require(')');
    return fmt::format("of_{}({})", called.code, code);
  }
  /// The end of a sentence on an unknown name.
  std::string known_names(const std::string& typed) const {
    const auto known =
        std::ranges::find(foreign, in_lower_case(typed), &decltype(foreign)::value_type::first);
    if (known != foreign.end()) return fmt::format("did you mean {}?", known->second);
    std::vector<std::string> all = *parameters_;
    for (const auto& coordinate : *variables_) all.push_back(coordinate.name);
    const auto functions_here = functions_of_formulas();
    all.insert(all.end(), functions_here.begin(), functions_here.end());
    const std::string near = typed.size() < 3 ? "" : nearest_name(typed, all);
    return near.empty() ? "functions are " + listed(functions_here) : fmt::format("did you mean {}?", near);
  }
  std::string of(const variable& coordinate, std::size_t from) {
    if (!coordinate.is_list) return fmt::format("q[{}]", coordinate.first);
    if (!takes('[')) {
      at_ = from;
      wrong(fmt::format("'{}'", coordinate.name), "have an index, as a list has",
            fmt::format("write {}[1]", coordinate.name));
    }
    const index which = index_sum();
    require(']');
    if (which.least < 1 || which.most > coordinate.count) {
      at_ = from;
      wrong("the coordinates", fmt::format("be {0}[1] to {0}[{1}], not {0}[{2}] to {0}[{3}]", coordinate.name,
                                           coordinate.count, which.least, which.most));
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
    const bool is_free = is_name(counter) && !is_name_of_grammar(counter) &&
                         std::ranges::count(*parameters_, counter) == 0 &&
                         std::ranges::count(counters_, counter, &counter_of_sum::name) == 0 &&
                         std::ranges::count(*variables_, counter, &variable::name) == 0;
    if (!is_free) {
      at_ = from;
      wrong("the counter of sum(i, first, last, term)", "have a name of its own");
    }
    require(',');
    const index first = index_sum();
    require(',');
    const index last = index_sum();
    require(',');
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
      if (total.least < -far || total.most > far) wrong("an index", "be at most 10^9 in magnitude");
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
      if (error != std::errc{} || value > most_coordinates)
        wrong("a number in an index", fmt::format("be at most {}", most_coordinates));
      at_ = static_cast<std::size_t>(end - text_.data());
      return {fmt::format("{}", value), value, value};
    }
    const auto from = at_;
    const std::string known = name();
    for (const auto& counter : counters_) {
      if (counter.name == known) return {"i_" + known, counter.first, counter.last};
    }
    at_ = from;
    wrong("an index", "be made of whole numbers, counters of sums, + and -");
  }

  std::string_view text_;
  const std::vector<variable>* variables_;
  const std::vector<std::string>* parameters_;
  std::vector<counter_of_sum> counters_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

bool is_name(std::string_view text) {
  return !text.empty() && begins_name(text.front()) && std::ranges::all_of(text, is_in_name);
}

std::vector<std::string> functions_of_formulas() {
  std::vector<std::string> names;
  for (const auto& one : functions) names.emplace_back(one.name);
  names.emplace_back("sum");
  return names;
}

std::string code_of_functions() {
  std::string code;
  std::set<std::string_view> written;
  for (const auto& one : functions) {
    if (!written.insert(one.code).second) continue;
    const bool is_ours = one.code == "sign" || one.code == "heaviside" || one.code == "mod";
    code += fmt::format(
        "template <class... X>\nauto of_{0}(const X&... x) {{\n  using {1}::{0};\n  return {0}(x...);\n}}\n",
        one.code, is_ours ? "nysalt" : "std");
  }
  return code;
}

bool is_name_of_grammar(std::string_view name) { return name == "sum" || function_named(name) != nullptr; }

std::string translated(std::string_view text, const std::vector<variable>& variables,
                       const std::vector<std::string>& parameters) {
  return translation(text, variables, parameters).whole();
}

}  // namespace nysalt::program
