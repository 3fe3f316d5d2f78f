// SPDX-License-Identifier: BSL-1.0
// Parameters in messages, as their reader writes them: fields of C++, arguments of Python, options of the
// program.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nysalt::program {

/// How a surface writes parameters, values, and the call that learns a family.
struct spelling {
  const char* prefix;    ///< before a name
  char between_words;    ///< of a name
  const char* learning;  ///< before a name of learning
  std::string_view (*renamed)(std::string_view field);
  const char* equals;       ///< between a parameter and the value
  const char* switched_on;  ///< behind a parameter that is on or off
  const char* quote;        ///< around a text
  const char* separator;    ///< between two parameters with values
  const char* learn;        ///< before the parameters of learning
  const char* learned;      ///< behind these
};

/// Sets the spelling of all later messages. Until the first call it is that of C++.
void spell(const spelling& surface);

/// learning.horizon (C++), learn_horizon (Python) or --learn-horizon (the program).
std::string spelled(std::string_view field);

/// With a value behind it, as in --for energy: texts in quotes but in the program, numbers of twelve digits.
std::string spelled(std::string_view field, std::string_view text);
std::string spelled(std::string_view field, double number);

/// force = true, force=True or --force.
std::string switched_on(std::string_view field);

/// Parameters with values, behind each other.
std::string spelled_together(const std::vector<std::string>& settings);

/// The call that learns a family, at a step and with a placement where these are known.
std::string spelled_learning(const std::string& family, std::string_view placement = {},
                             std::optional<double> step = {});

}  // namespace nysalt::program
