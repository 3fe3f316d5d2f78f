// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string_view>
#include <vector>

#include "nysalt/families/symmetric_composition.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/methods/forest_ruth.hpp"
#include "nysalt/methods/mclachlan.hpp"
#include "nysalt/methods/pefrl.hpp"

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

  /// Order conditions ask of K but that it is quadratic in p.
  static std::vector<classical_member<base::parameters>> classical_members() {
    if constexpr (Kicks == 2) return {{"mclachlan2", base::of(mclachlan2())}};
    if constexpr (Kicks == 3) return {{"forest_ruth", base::of(forest_ruth())}};
    if constexpr (Kicks == 4) return {{"pefrl", base::of(pefrl())}};
    if constexpr (Kicks == 5) return {{"mclachlan5", base::of(mclachlan5())}};
    return {};
  }
};

}  // namespace nysalt
