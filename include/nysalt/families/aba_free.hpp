// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "nysalt/detail/palindrome.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"

namespace nysalt {

/// A(a1) B(b1) A(a2) B(b2) ... with s kicks, not symmetric: all but the last coefficient of each letter,
/// which follow from the sums, are parameters. s evaluations. What is learned has the order 1 in truth, with
/// a tiny constant: never take it to a smaller step.
template <int Kicks>
  requires(Kicks == 3 || Kicks == 4)
struct aba_free : composition<2 * Kicks - 1> {
  using word = alternating_word<drift, kick, 2 * Kicks + 1>;
  static constexpr std::size_t free = 2 * Kicks - 1;
  static constexpr std::string_view name = Kicks == 3 ? "aba3_free" : "aba4_free";
  static constexpr auto parameter_names = names_in_turn<free>(false);

  /// Equal steps of drift-kick-drift.
  static std::array<double, free> start() {
    std::array<double, free> all;
    all.fill(1.0 / Kicks);
    all[0] = 0.5 / Kicks;
    return all;
  }

  /// Where searches from forty random starts on the FPU chain (omega = 50, step .011 an evaluation) ended:
  /// few of them come there, and for other systems and steps it is not far.
  static std::vector<std::array<double, free>> further_starts() {
    if constexpr (Kicks == 3) return {{0.2012, 0.69, -0.2001, -0.1225, 0.8345}};
    if constexpr (Kicks == 4) return {{0.139, 0.5615, -0.0879, -0.1647, 0.5254, 0.3488, 0.3247}};
  }

  template <Scalar C>
  static std::array<C, free + 2> coefficients(const std::array<C, free>& theta) {
    std::array<C, free + 2> all;
    C a(1.0);
    C b(1.0);
    for (std::size_t k = 0; k < free; ++k) {
      all[k] = theta[k];
      (k % 2 == 0 ? a : b) -= theta[k];
    }
    all[free] = b;
    all[free + 1] = a;
    return all;
  }
};

using aba3_free = aba_free<3>;  ///< three kicks, five parameters
using aba4_free = aba_free<4>;  ///< four kicks, seven parameters

}  // namespace nysalt
