// SPDX-License-Identifier: BSL-1.0
// Templates of hosts, read: a head that says what the host takes, and the text with its placeholders,
// conditions and loops. The language: docs/how-to/export_template.md.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace nysalt::detail {

/// One of the terms of a condition: `has LETTER`, `PLACEHOLDER is TEXT`, or a name; each also after `not`.
struct template_term {
  bool is_negated = false;
  std::string_view name = {};   ///< `has`, a placeholder, or a name of conditions()
  std::string_view value = {};  ///< the letter or the text; empty for a name of conditions()
};
/// Terms all of which must hold.
using template_condition = std::vector<template_term>;

/// A part of a text.
struct template_piece {
  enum class kind { text, placeholder, choice, loop };

  kind is;
  std::size_t line;       ///< in the file, from 1
  std::string_view text;  ///< the text itself, or the name of the placeholder or of the word of a loop
  template_condition condition = {};       ///< condition of a choice
  std::vector<template_piece> first = {};  ///< text where the condition holds, or text of each letter
  /// Text where the condition does not hold, or text between letters.
  std::vector<template_piece> second = {};
};
using template_text = std::vector<template_piece>;

/// What a method must be for a host, and the message for other methods.
struct template_requirement {
  std::size_t line;
  template_condition condition;
  template_text refusal;
};

/// A template; what it holds are parts of the text that it was read from.
struct export_template {
  std::string_view file;              ///< name in messages
  std::string_view title;             ///< name of the host in messages
  std::string_view place = {};        ///< hosts are listed in the order of their places
  std::string_view what = {};         ///< content of the exported text
  std::string_view suffix = {};       ///< suffix of a file with the exported text
  std::string_view takes = {};        ///< letters, and "processor" where words with a processor are taken
  std::string_view comment = " ";     ///< what begins a line of a comment
  std::string_view uncommented = {};  ///< what must not stand in a comment
  /// What stands between the digits and the exponent of a number; each number has one other than e.
  std::string_view exponent = "e";
  std::vector<template_requirement> requirements = {};
  std::size_t first_after_letters = 0;  ///< the first requirement that is checked after the letters
  std::string_view body = {};           ///< the text below the head
  std::size_t body_line = 0;            ///< line of the file in which the text begins
};

/// The head of a template. Throws std::invalid_argument, with file and line, for what is not the language.
export_template head_of_template(std::string_view text, std::string_view file);

/// The text of a template below the head. Throws std::invalid_argument, with file and line, for what is not
/// the language, also in parts that no method reaches.
template_text text_of_template(const export_template& read);

/// The condition in words. Throws std::invalid_argument, which begins with `where`, for unknown names.
template_condition condition_in(std::string_view words, bool is_in_loop, const std::string& where);

}  // namespace nysalt::detail
