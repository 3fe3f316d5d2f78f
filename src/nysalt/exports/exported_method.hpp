// SPDX-License-Identifier: BSL-1.0
// A method on the way to another language or code.
#pragma once

#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/method.hpp"

namespace nysalt::detail {

/// Throws std::invalid_argument with the formatted message.
template <class... A>
[[noreturn]] void refuse_export(fmt::format_string<A...> text, A&&... values) {
  throw std::invalid_argument(fmt::format(text, std::forward<A>(values)...));
}

/// A method for export, and what the header of the exported text says about the method.
struct exported_method {
  nysalt::method method;
  std::string name;                ///< an identifier in all hosts
  std::vector<std::string> about;  ///< lines of the header: what it is, what it was learned for, how to cite
};

/// A letter with its coefficients.
struct exported_letter {
  char letter;     ///< A, B, D or O
  double c;        ///< the coefficient of A, B and O, and b of D(b, c)
  double d = 0.0;  ///< c of D(b, c)
};
using exported_word = std::vector<exported_letter>;

/// The kernel that is stepped. Throws std::invalid_argument for letters that no host has.
exported_word kernel_of(const exported_method& method);
/// The word before the first step; empty without a processor.
exported_word start_of(const exported_method& method);
/// The word on a copy of the state that is observed; empty without a processor.
exported_word finish_of(const exported_method& method);
/// The kernel without letters of coefficient zero, whose neighbouring drifts are one, and neighbouring kicks.
exported_word composition_of(const exported_method& method);

std::string letters_written(const exported_word& word);
/// Both coefficients of letters D.
std::vector<double> coefficients_of(const exported_word& word);

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

}  // namespace nysalt::detail
