// SPDX-License-Identifier: BSL-1.0
// A method on the way to another language or code, and words of drifts and kicks, for hosts that take lists.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/method.hpp"

namespace nysalt::detail {

/// A method for export, and what the header of the exported text says about the method.
struct exported_method {
  tabulated method;
  std::string name;                ///< an identifier in all hosts
  std::vector<std::string> about;  ///< lines of the header: what it is, what it was learned for, how to cite
};

/// Letters with the coefficients that they take, as a program in which a gradient kick is a displaced one.
struct exported_letters {
  std::string letters;               ///< A, B, D and O
  std::vector<double> coefficients;  ///< one for A, B and O; b and c for D

  /// Number of letters `letter`.
  std::size_t count(char letter) const;
};

/// The kernel that is stepped.
exported_letters kernel_of(const exported_method& method);
/// The word before the first step; empty without a processor.
exported_letters start_of(const exported_method& method);
/// The word on a copy of the state that is observed; empty without a processor.
exported_letters finish_of(const exported_method& method);

/// Whether the method has letters O, of a bath.
bool has_bath(const exported_method& method);

/// The same method with D(b, 2 c/b) for each G(b, c), of order 4 at most. Throws std::invalid_argument for a
/// letter G with b = 0.
exported_method with_displaced_kicks(const exported_method& method);

/// The pinned problem of self-tests: two coupled oscillators with the masses 1 and 2,
/// f = (-q1 - 2 q1 q2, -q2 - q1^2 + q2^2), from q = (0.3, 0.2), p = (0.1, -0.25), 10 steps of 0.1; letters O
/// in a bath of friction 1.5 and kT 0.7, where sin(1), sin(2), ... replace normal numbers, in the order in
/// which they are drawn.
struct self_test {
  std::vector<double> q, p;  ///< where nysalt's own stepper ends
};
self_test self_test_of(const exported_method& method);

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
