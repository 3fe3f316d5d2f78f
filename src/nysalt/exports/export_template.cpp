// SPDX-License-Identifier: BSL-1.0

#include "export_template.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "exported_method.hpp"
#include "placeholders.hpp"

namespace nysalt::detail {

namespace {

/// Names of a table, for messages.
std::string names_of(const auto& table) {
  std::string result;
  for (const auto& row : table) result += fmt::format("{}{}", result.empty() ? "" : ", ", row.name);
  return result;
}

const auto* row_of(const auto& table, std::string_view name) {
  const auto found = std::ranges::find(table, name, [](const auto& row) { return row.name; });
  return found == table.end() ? nullptr : &*found;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const auto begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

/// Takes the text up to the mark, and the mark, off the front of a text; all of the text where there is no
/// mark.
std::string_view take_until(std::string_view& text, char mark) {
  const auto end = std::min(text.find(mark), text.size());
  const std::string_view taken = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return taken;
}

/// Takes a word and the blanks around it off the front of a text; empty at the end of the text.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  return take_until(text, ' ');
}

void require_placeholder(std::string_view name, bool is_in_loop, const std::string& where) {
  const placeholder* found = row_of(placeholders(), name);
  if (found == nullptr)
    refuse_export("{}: unknown placeholder '{}': it is one of {}", where, name, names_of(placeholders()));
  if (found->needs == "loop" && !is_in_loop)
    refuse_export("{}: @{}@ must stand between @for WORD@ and @end@, got it outside", where, name);
}

/// Reads a text with tags.
class text_reader {
 public:
  text_reader(std::string_view file, std::string_view text, std::size_t line)
      : file_(file), text_(text), line_(line) {}

  /// The whole text.
  template_text all() {
    auto [result, closing] = until_closed(false);
    if (!closing.empty()) {
      refuse_export("{}: @{}@ must come after the @if ...@ or @for ...@ that it belongs to, got none",
                    where(), closing);
    }
    return std::move(result);
  }

 private:
  std::string where() const { return fmt::format("{}:{}", file_, line_of(tag_)); }

  std::size_t line_of(std::size_t place) const {
    const auto before = text_.substr(0, place);
    return line_ + static_cast<std::size_t>(std::ranges::count(before, '\n'));
  }

  /// Goes to the next tag: what stands between two @, begins with a small letter and ends without a blank.
  /// Other @ stand for themselves. Empty at the end of the text.
  std::string_view next_tag() {
    constexpr std::string_view characters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_ ";
    for (tag_ = text_.find('@', at_); tag_ != std::string_view::npos; tag_ = text_.find('@', tag_ + 1)) {
      const auto end = text_.find_first_not_of(characters, tag_ + 1);
      if (end == std::string_view::npos || text_[end] != '@') continue;
      const auto words = text_.substr(tag_ + 1, end - tag_ - 1);
      if (words.empty() || words.front() < 'a' || words.front() > 'z' || words.back() == ' ') continue;
      return words;
    }
    tag_ = text_.size();
    return {};
  }

  /// Takes the text before the tag, and the tag. A line that has nothing but a tag of a condition or a loop
  /// is left out, with its end.
  template_piece text_before(std::string_view tag, bool is_placeholder) {
    std::size_t end = tag_;
    std::size_t next = tag.empty() ? tag_ : tag_ + tag.size() + 2;
    if (!tag.empty() && !is_placeholder) {
      const auto newline = text_.substr(0, tag_).rfind('\n');
      const std::size_t line = newline == std::string_view::npos ? 0 : newline + 1;
      const auto behind = text_.substr(next, text_.find('\n', next) - next);
      if (trimmed(text_.substr(line, tag_ - line)).empty() && trimmed(behind).empty()) {
        end = line;
        next = std::min(next + behind.size() + 1, text_.size());
      }
    }
    template_piece result{template_piece::kind::text, line_of(at_), text_.substr(at_, end - at_)};
    at_ = next;
    return result;
  }

  /// Reads up to a tag that ends the pieces, which is returned with them: else, between or end; empty at the
  /// end of the text.
  std::pair<template_text, std::string_view> until_closed(bool is_in_loop) {
    template_text result;
    while (true) {
      const std::string_view tag = next_tag();
      std::string_view rest = tag;
      const std::string_view word = take_word(rest);
      const bool closes = tag.empty() || tag == "else" || tag == "between" || tag == "end";
      const bool opens = word == "if" || word == "for";
      result.push_back(text_before(tag, !closes && !opens));
      if (closes) return {std::move(result), tag};
      if (opens) {
        result.push_back(block(word, rest, is_in_loop));
      } else {
        require_placeholder(tag, is_in_loop, where());
        result.push_back({template_piece::kind::placeholder, line_of(tag_), tag});
      }
    }
  }

  /// What stands from @if ...@ or @for ...@ to @end@.
  template_piece block(std::string_view kind, std::string_view rest, bool is_in_loop) {
    constexpr int deepest = 20;
    const bool is_loop = kind == "for";
    const std::string opened = where();
    if (is_loop && is_in_loop)
      refuse_export("{}: a loop must not stand in another loop, got @for {}@", opened, rest);
    if (++depth_ > deepest)
      refuse_export("{}: conditions must be nested at most {} deep, got @if {}@", opened, deepest, rest);
    template_piece result{is_loop ? template_piece::kind::loop : template_piece::kind::choice, line_of(tag_),
                          rest};
    if (is_loop && row_of(words(), rest) == nullptr)
      refuse_export("{}: unknown word '{}': it is one of {}", opened, rest, names_of(words()));
    if (!is_loop) result.condition = condition_in(rest, is_in_loop, opened);
    const std::string_view middle = is_loop ? "between" : "else";
    std::string_view closing;
    std::tie(result.first, closing) = until_closed(is_loop || is_in_loop);
    if (closing == middle) std::tie(result.second, closing) = until_closed(is_in_loop);
    --depth_;
    if (closing != "end") {
      refuse_export(
          "{}: @{} {}@ must be followed by @end@, got {}", opened, kind, rest,
          closing.empty() ? "the end of the text" : fmt::format("@{}@ in line {}", closing, line_of(tag_)));
    }
    return result;
  }

  std::string_view file_, text_;
  std::size_t line_;
  std::size_t at_ = 0;   ///< what is read next
  std::size_t tag_ = 0;  ///< where the last tag begins
  int depth_ = 0;        ///< conditions and loops that are open
};

/// Keys of a head with one value.
struct head_key {
  std::string_view name;
  std::string_view export_template::*value;
};
constexpr std::array head_keys{head_key{"title", &export_template::title},
                               head_key{"place", &export_template::place},
                               head_key{"what", &export_template::what},
                               head_key{"suffix", &export_template::suffix},
                               head_key{"takes", &export_template::takes},
                               head_key{"comment", &export_template::comment},
                               head_key{"uncommented", &export_template::uncommented},
                               head_key{"exponent", &export_template::exponent}};

void require_letters(std::string_view takes, const std::string& where) {
  if (takes.find('A') == std::string_view::npos || takes.find('B') == std::string_view::npos)
    refuse_export("{}: takes must hold the letters A and B, got '{}'", where, takes);
  std::string_view rest = takes;
  for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
    const bool is_letter = word.size() == 1 && std::string_view("ABDO").find(word) != std::string_view::npos;
    if (!is_letter && word != "processor")
      refuse_export("{}: takes must hold letters A, B, D and O and the word processor, got '{}'", where,
                    word);
  }
}

}  // namespace

template_condition condition_in(std::string_view words, bool is_in_loop, const std::string& where) {
  template_condition result;
  std::string_view rest = words;
  while (true) {
    template_term term{.name = take_word(rest)};
    term.is_negated = term.name == "not";
    if (term.is_negated) term.name = take_word(rest);
    if (term.name == "has") {
      term.value = take_word(rest);
      if (term.value.size() != 1)
        refuse_export("{}: has must be followed by a letter, got '{}'", where, term.value);
    } else if (trimmed(rest).starts_with("is ")) {
      take_word(rest);
      term.value = take_word(rest);
      require_placeholder(term.name, is_in_loop, where);
    } else if (row_of(conditions(), term.name) == nullptr) {
      refuse_export("{}: unknown condition '{}': it is one of has LETTER, PLACEHOLDER is TEXT, {}", where,
                    term.name, names_of(conditions()));
    }
    result.push_back(term);
    if (trimmed(rest).empty()) return result;
    if (take_word(rest) != "and")
      refuse_export("{}: terms of a condition must be joined by and, got '{}'", where, words);
  }
}

export_template head_of_template(std::string_view text, std::string_view file) {
  std::string_view stem = file.substr(file.find_last_of('/') + 1);
  export_template result{.file = file, .title = stem.substr(0, stem.find('.'))};
  std::size_t line = 0;
  while (true) {
    if (text.empty()) refuse_export("{}: the head must end with a line ---, got none", file);
    ++line;
    const std::string where = fmt::format("{}:{}", file, line);
    const std::string_view whole = trimmed(take_until(text, '\n'));
    if (whole == "---") break;
    std::string_view value = whole;
    const std::string_view key = take_until(value, ':');
    value = trimmed(value);
    if (value.empty()) refuse_export("{}: a line of the head must be KEY: VALUE, got '{}'", where, whole);
    if (key.starts_with("require ")) {
      result.requirements.push_back(
          {line, condition_in(key.substr(8), false, where), text_reader(file, value, line).all()});
      continue;
    }
    const head_key* known = row_of(head_keys, key);
    if (known == nullptr)
      refuse_export("{}: unknown key '{}': it is one of require CONDITION, {}", where, key,
                    names_of(head_keys));
    result.*known->value = value;
    if (key != "takes") continue;
    require_letters(value, where);
    result.first_after_letters = result.requirements.size();
  }
  if (result.takes.empty())
    refuse_export("{}: the head must have a line takes, such as takes: A B, got none", file);
  result.body = text;
  result.body_line = line + 1;
  return result;
}

template_text text_of_template(const export_template& read) {
  return text_reader(read.file, read.body, read.body_line).all();
}

}  // namespace nysalt::detail
