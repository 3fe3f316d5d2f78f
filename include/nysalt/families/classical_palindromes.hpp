// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <vector>

#include "nysalt/families/symmetric_composition.hpp"
#include "nysalt/methods/classical.hpp"

namespace nysalt {

/// The classical methods A B ... B A with that number of kicks, as members of a family F of such words.
/// Rotations may replace the drifts: of K, order conditions ask but that it is quadratic in p.
template <class F, int Kicks>
std::vector<classical_member<F::parameters>> classical_palindromes() {
  if constexpr (Kicks == 2) return {{"mclachlan2", F::of(mclachlan2())}};
  if constexpr (Kicks == 3) return {{"forest_ruth", F::of(forest_ruth())}};
  if constexpr (Kicks == 4) return {{"pefrl", F::of(pefrl())}};
  if constexpr (Kicks == 5) {
    return {{"mclachlan5", F::of(mclachlan5())}, {"omelyan5p", F::of(omelyan5p())}};
  }
  return {};
}

}  // namespace nysalt
