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
};

}  // namespace nysalt
