// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "nysalt/families/symmetric_composition.hpp"
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/methods/classical.hpp"

namespace nysalt {

/// B A B ... A B with s drifts: s evaluations.
template <int Drifts>
  requires(Drifts >= 2 && Drifts < 10)
struct bab : symmetric_composition<kick, drift, 2 * Drifts + 1> {
 private:
  using base = symmetric_composition<kick, drift, 2 * Drifts + 1>;
  static constexpr detail::numbered_name<4> text{"bab", Drifts};

 public:
  static constexpr std::string_view name{text.text.data(), text.text.size()};

  static std::vector<classical_member<base::parameters>> classical_members() {
    if constexpr (Drifts == 2) {
      return {{"mclachlan2v", base::of(mclachlan2v())}, {"bcss2v", base::of(bcss2v())}};
    }
    if constexpr (Drifts == 3) {
      return {{"bcss3", base::of(bcss3())}, {"predescu3", base::of(predescu3())}};
    }
    if constexpr (Drifts == 4) return {{"vefrl", base::of(vefrl())}, {"bcss4", base::of(bcss4())}};
    if constexpr (Drifts == 5) return {{"omelyan5v", base::of(omelyan5v())}};
    if constexpr (Drifts == 6) return {{"srkn6b", base::of(srkn6b())}};
    return {};
  }
};

}  // namespace nysalt
