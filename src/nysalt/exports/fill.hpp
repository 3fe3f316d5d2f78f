// SPDX-License-Identifier: BSL-1.0
// Refusals of exports, in one line.
#pragma once

#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exported_method.hpp"

namespace nysalt::detail {

/// Throws std::invalid_argument with the formatted message.
template <class... A>
[[noreturn]] void refuse_export(fmt::format_string<A...> text, A&&... values) {
  throw std::invalid_argument(fmt::format(text, std::forward<A>(values)...));
}

// Source text with gaps.

/// Texts for gaps, by the key of the gap.
using gap_texts = std::vector<std::pair<std::string, std::string>>;

/// The text with each @KEY@ replaced. Throws std::logic_error where a gap has no value.
std::string fill(std::string_view text, const gap_texts& values);

/// The number so that reading it gives the same bits, with a decimal point or an exponent.
std::string digits(double value);
/// Such numbers, joined; `exponent` replaces the e of an exponent, and is added where there is none unless it
/// is 'e'.
std::string digits(const std::vector<double>& values, char exponent = 'e');

/// The lines of the header, each after `mark`.
std::string header(const exported_method& method, std::string_view mark);

/// What all texts are filled with: NAME, HEADER, EXPLAINED (what the letters do), Q and P (where the
/// self-test ends), MAIN (the self-test as a program in Python).
gap_texts values_of_header(const exported_method& method, std::string_view mark, char exponent = 'e');
/// Those, and of KERNEL, START and FINISH letters and coefficients.
gap_texts values_of(const exported_method& method, std::string_view mark, char exponent = 'e');

/// Adds texts about the bath: filled for a method with letters O, and empty for others.
void add_bath(gap_texts& values, const exported_method& method, const gap_texts& of_bath);

}  // namespace nysalt::detail
