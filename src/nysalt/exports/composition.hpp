// SPDX-License-Identifier: BSL-1.0
// Words of drifts and kicks, for hosts that take them as lists.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fill.hpp"

namespace nysalt::detail {

/// The letters A and B with their coefficients; neighbours of one kind are joined, and letters of coefficient
/// zero left out. Throws std::invalid_argument, naming the host, for a word with a processor or other
/// letters.
exported_letters composition_of(const exported_method& method, const std::string& host);
/// The same with letters O, for hosts that have a bath.
exported_letters composition_in_bath_of(const exported_method& method, const std::string& host);

/// Whether it reads the same from both ends, to rounding: the coefficients of schemes are sums.
bool is_palindrome(const exported_letters& word);

/// Drifts and kicks as stages of two letters, zero where a stage has only one; the letters that are `first`
/// in a stage, and the others.
std::pair<std::vector<double>, std::vector<double>> in_stages(const exported_letters& word, char first);

/// The parameter of B(lambda) A(1/2) B(1 - 2 lambda) A(1/2) B(lambda). Throws std::invalid_argument, naming
/// the host, for another word.
double two_stage_lambda(const exported_method& method, const std::string& host);

}  // namespace nysalt::detail
