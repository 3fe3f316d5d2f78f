// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string_view>
#include <vector>

#include "nysalt/families/classical_palindromes.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/flows/rotation.hpp"

namespace nysalt {

/// R S R ... S R with s soft kicks, for systems that declare a quadratic part: the impulse method is its like
/// with one. Exact where nothing is soft.
template <int Kicks>
  requires(Kicks >= 2 && Kicks < 10)
struct r_aba : symmetric_composition<rotation, soft_kick, 2 * Kicks + 1> {
 private:
  using base = symmetric_composition<rotation, soft_kick, 2 * Kicks + 1>;
  static constexpr detail::numbered_name<6> text{"r_aba", Kicks};

 public:
  static constexpr std::string_view name{text.text.data(), text.text.size()};
  static constexpr std::string_view source = "tuckerman_berne_martyna_1992";

  static std::vector<classical_member<base::parameters>> classical_members() {
    return classical_palindromes<base, Kicks>();
  }
};

}  // namespace nysalt
