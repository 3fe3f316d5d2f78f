// SPDX-License-Identifier: BSL-1.0
// Source text with gaps.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exported_method.hpp"

namespace nysalt::program {

/// The text with each @KEY@ replaced. Throws std::logic_error where a gap has no value.
std::string fill(std::string_view text, const std::vector<std::pair<std::string, std::string>>& values);

/// The number so that reading it gives the same bits, with a decimal point or an exponent.
std::string digits(double value);
/// Such numbers, joined; `exponent` replaces the e of an exponent, and is added where there is none unless it
/// is 'e'.
std::string digits(const std::vector<double>& values, char exponent = 'e');

/// The lines of the header, each after `mark`.
std::string header(const exported_method& method, std::string_view mark);

/// What all programs of letters are filled with: NAME, HEADER, of KERNEL, START and FINISH letters and
/// coefficients, and where the self-test ends.
std::vector<std::pair<std::string, std::string>> values_of(const exported_method& method,
                                                           std::string_view mark, char exponent = 'e');

}  // namespace nysalt::program
