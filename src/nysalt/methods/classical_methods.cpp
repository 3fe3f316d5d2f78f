// SPDX-License-Identifier: BSL-1.0
// All classical methods of the library, as data.
#include "nysalt/methods/classical_methods.hpp"

#include "nysalt/methods/bcss.hpp"
#include "nysalt/methods/blanes_moan.hpp"
#include "nysalt/methods/chin.hpp"
#include "nysalt/methods/forest_ruth.hpp"
#include "nysalt/methods/impulse.hpp"
#include "nysalt/methods/mclachlan.hpp"
#include "nysalt/methods/mclachlan_atela.hpp"
#include "nysalt/methods/omelyan.hpp"
#include "nysalt/methods/pefrl.hpp"
#include "nysalt/methods/predescu.hpp"
#include "nysalt/methods/repeated.hpp"
#include "nysalt/methods/takahashi_imada.hpp"
#include "nysalt/methods/verlet.hpp"

namespace nysalt {

std::vector<tabulated> classical_methods() {
  return {tabulated(bcss4{}),
          tabulated(predescu3{}),
          tabulated(vefrl{}),
          tabulated(omelyan5v{}),
          tabulated(omelyan5p{}),
          tabulated(omelyan_fg4{}),
          tabulated(verlet{}),
          tabulated(verlet_aba{}),
          tabulated(impulse{}),
          tabulated(mclachlan2{}),
          tabulated(bcss2{}),
          tabulated(takahashi_imada{}),
          tabulated(bcss3{}),
          tabulated(forest_ruth{}),
          tabulated(chin4a{}),
          tabulated(pefrl{}),
          tabulated(mclachlan_atela4{}),
          tabulated(mclachlan5{}),
          tabulated(blanes_moan_s6{}),
          tabulated(srkn6b{}),
          tabulated(srkn11b{}),
          tabulated(srkn14a{})};
}

std::vector<tabulated> classical_methods_of_cost(int evaluations) {
  std::vector<tabulated> result;
  for (const auto& method : classical_methods()) {
    const int each = method.letters().evaluations_per_step;
    if (evaluations % each != 0) continue;
    result.push_back(repeated(method, evaluations / each));
  }
  return result;
}

}  // namespace nysalt
