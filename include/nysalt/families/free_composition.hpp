// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string_view>

#include "nysalt/detail/palindrome.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/bab.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"

namespace nysalt {

/// X(x1) Y(y1) X(x2) Y(y2) ... with s letters Y, not symmetric: all but the last coefficient of each letter,
/// which follow from the sums, are parameters. s evaluations. What is learned has the order 1 in truth, with
/// a tiny constant: never take it to a smaller step.
template <Flow Outer, Flow Inner, int Stages>
struct free_composition : composition<2 * Stages - 1> {
  using word = alternating_word<Outer, Inner, 2 * Stages + 1>;
  static constexpr std::size_t free = 2 * Stages - 1;
  static constexpr auto parameter_names = names_in_turn<free>(Outer::reads != field::none);

  /// Equal steps of drift-kick-drift, or of kick-drift-kick.
  static std::array<double, free> start() {
    std::array<double, free> all;
    all.fill(1.0 / Stages);
    all[0] = 0.5 / Stages;
    return all;
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

/// A B ... A with three kicks, five parameters.
struct aba3_free : free_composition<drift, kick, 3> {
  static constexpr std::string_view name = "aba3_free";
  using contained = aba<3>;
};
/// A B ... A with four kicks, seven parameters.
struct aba4_free : free_composition<drift, kick, 4> {
  static constexpr std::string_view name = "aba4_free";
  using contained = aba<4>;
};
/// A B ... A with six kicks, eleven parameters.
struct aba6_free : free_composition<drift, kick, 6> {
  static constexpr std::string_view name = "aba6_free";
  using contained = aba<6>;
};
/// B A ... B with six drifts, eleven parameters.
struct bab6_free : free_composition<kick, drift, 6> {
  static constexpr std::string_view name = "bab6_free";
  using contained = bab<6>;
};

}  // namespace nysalt
