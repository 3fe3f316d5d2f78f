// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/detail/palindrome.hpp"
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"

namespace nysalt {

/// Common members of all symmetric compositions of drifts and kicks; a method adds its name, order and
/// coefficients.
template <Flow Outer, Flow Inner, std::size_t Length>
struct palindromic {
  using word = alternating_word<Outer, Inner, Length>;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
};

}  // namespace nysalt
