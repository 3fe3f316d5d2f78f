// SPDX-License-Identifier: BSL-1.0
// Words of drifts and kicks alone, for hosts that take them as lists.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "exported_method.hpp"

namespace nysalt::program {

/// The coefficients of letters that are A and B in turn, on one list; neighbours of one kind are joined and
/// letters of coefficient zero left out. Throws refusal, naming the host, for a word with a processor or
/// other letters.
exported_letters composition_of(const exported_method& method, const std::string& host);

/// Whether it reads the same from both ends, to rounding: the coefficients of schemes are sums.
bool is_palindrome(const exported_letters& word);

/// Drifts and kicks as stages of two letters, zero where a stage has one alone; the letters that are `first`
/// in a stage, and the others.
std::pair<std::vector<double>, std::vector<double>> in_stages(const exported_letters& word, char first);

/// What a Python file of a list is filled with.
std::vector<std::pair<std::string, std::string>> values_of_list(const exported_method& method,
                                                                const std::vector<double>& list);

}  // namespace nysalt::program
