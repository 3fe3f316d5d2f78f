// SPDX-License-Identifier: BSL-1.0
#include "toml_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "comparison/json.hpp"
#include "comparison/refusal.hpp"

// Compiled here, so that the program does not need the shared library where it runs.
#ifdef TOML_HEADER_ONLY
#undef TOML_HEADER_ONLY
#endif
#define TOML_HEADER_ONLY 1
// toml++ asserts that a name follows "[" before it looks, and with NDEBUG lets the compiler rely on it.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace nysalt::program {

namespace {

/// Whether TOML has the text for a number.
bool is_number(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string::npos) return false;
  try {
    return toml::parse("x=" + text)["x"].is_number();
  } catch (const toml::parse_error&) {
    return false;
  }
}

/// A text of JSON is one of TOML. Controls, and bytes that are no UTF-8, which TOML does not have, are
/// replaced.
std::string in_quotes(const std::string& text) { return json(of_letters(text)).dump(); }

/// Nothing of what is no number, text or truth value.
std::optional<std::string> text_of_scalar(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* whole = node.as_integer()) return fmt::format("{}", whole->get());
  if (const auto* real = node.as_floating_point()) {
    auto digits = fmt::format("{}", real->get());
    if (std::isfinite(real->get()) && digits.find_first_of(".e") == std::string::npos) digits += ".0";
    return digits;
  }
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  return std::nullopt;
}

const char* kind_of(const toml::node& node) {
  if (node.is_table()) return "a table";
  return node.is_array() ? "a list" : "a date or time";
}

std::string text_in(const toml::node& node, const std::string& who, std::string_view name,
                    const char* condition) {
  if (const auto text = text_of_scalar(node)) return *text;
  refuse("{}, line {}: {} must {}, got {}", who, node.source().begin.line, of_letters(name), condition,
         kind_of(node));
}

toml_option option_in(const std::string& section, const toml::key& key, const toml::node& node,
                      const std::string& who) {
  toml_option result{
      .section = section, .name = std::string(key.str()), .values = {}, .line = key.source().begin.line};
  if (const auto* list = node.as_array()) {
    for (const auto& element : *list) {
      result.values.push_back(
          text_in(element, who, key.str(), "be a list of numbers, texts, true and false alone"));
    }
  } else if (const auto* table = node.as_table()) {
    result.is_table = true;
    for (const auto& [name, value] : *table) {
      const auto text = text_in(value, who, name.str(), "be a number, a text, true or false");
      result.values.push_back(fmt::format("{}={}", name.str(), text));
    }
  } else {
    result.values.push_back(
        text_in(node, who, key.str(), "be a number, a text, true or false, or a list of these"));
  }
  return result;
}

toml::table table_in(const std::string& text, const std::string& who) {
  // Each part of a dotted key is a level of the call stack of toml++, where 20000 are too many.
  constexpr std::ptrdiff_t most_dots = 5000;
  if (const auto dots = std::ranges::count(text, '.'); dots > most_dots) {
    refuse("{}: the file must have at most {} dots, got {}", who, most_dots, dots);
  }
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& problem) {
    std::string why = of_letters(problem.description());
    why.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(why.front())));
    refuse("{}, line {}: the file must be TOML: {}; write name = value, texts in quotes, lists in brackets",
           who, problem.source().begin.line, why);
  }
}

}  // namespace

std::vector<toml_option> options_in_toml(const std::string& text, const std::string& who,
                                         const std::function<bool(const std::string&)>& is_option) {
  std::vector<toml_option> all;
  for (const toml::table whole = table_in(text, who); const auto& [key, node] : whole) {
    const std::string name(key.str());
    const auto* section = node.as_table();
    if (section == nullptr || section->is_inline() || is_option(name)) {
      all.push_back(option_in("", key, node, who));
      continue;
    }
    all.push_back({.section = name, .name = "", .values = {}, .line = key.source().begin.line});
    for (const auto& [inner, value] : *section) all.push_back(option_in(name, inner, value, who));
  }
  std::ranges::stable_sort(all, {}, &toml_option::line);
  return all;
}

std::string as_toml(const std::vector<std::string>& values) {
  std::string all;
  for (const auto& text : values) {
    const bool is_bare = text == "true" || text == "false" || is_number(text);
    all += (all.empty() ? "" : ", ") + (is_bare ? text : in_quotes(text));
  }
  return values.size() == 1 ? all : "[" + all + "]";
}

}  // namespace nysalt::program
