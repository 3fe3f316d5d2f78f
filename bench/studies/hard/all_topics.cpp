// SPDX-License-Identifier: BSL-1.0
#include "hard_case.hpp"

namespace nysalt::hard {

std::vector<topic> all_topics() {
  return {stability(),        stiffness(), several_forces(), orbits(),    collisions(),
          rough_potentials(), baths(),     long_runs(),      magnitudes()};
}

}  // namespace nysalt::hard
