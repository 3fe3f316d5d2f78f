// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "nysalt/families/classical_palindromes.hpp"
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"

namespace nysalt {

/// A B A ... B A with s kicks: s evaluations.
template <int Kicks>
  requires(Kicks >= 2 && Kicks < 10)
struct aba : symmetric_composition<drift, kick, 2 * Kicks + 1> {
 private:
  using base = symmetric_composition<drift, kick, 2 * Kicks + 1>;
  static constexpr detail::numbered_name<4> text{"aba", Kicks};

 public:
  static constexpr std::string_view name{text.text.data(), text.text.size()};

  static std::vector<classical_member<base::parameters>> classical_members() {
    return classical_palindromes<base, Kicks>();
  }

  /// Where searches from forty random starts on the FPU chain (omega = 50, step .011 an evaluation) ended:
  /// few of them come there, and for other systems and steps it is not far.
  static std::vector<std::array<double, base::free>> further_starts() {
    if constexpr (Kicks == 4) return {{0.1854, 0.5605, -0.2195}};
    if constexpr (Kicks == 5) return {{0.106, 0.342, -0.2932, -0.0247}};
    if constexpr (Kicks == 6) return {{0.1404, -0.3301, -0.015, 0.5495, 0.2152}};
    return {};
  }
};

}  // namespace nysalt
