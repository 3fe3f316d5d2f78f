// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string>

#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// B(b1) A(a1) B(b2) A(a2) B(b3) A(a3) B(b4) A(a4), not symmetric: order 4 for quadratic K(p), else 3; four
/// evaluations [mclachlan_atela_1992]. Begun with a drift, the same coefficients have order 3.
struct mclachlan_atela4 {
  using word = nysalt::word<kick, drift, kick, drift, kick, drift, kick, drift>;
  static constexpr int order = 4;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = true;
  static std::string name() { return "mclachlan_atela4"; }
  static constexpr std::array<double, 8> coefficients() {
    return {0.1344961992774310892,  0.5153528374311229364,  //
            -0.2248198030794208058, -0.085782019412973646,  //
            0.7563200005156682911,  0.4415830236164665242,  //
            0.3340036032863214255,  0.1288461583653841854};
  }
};

}  // namespace nysalt
