// SPDX-License-Identifier: BSL-1.0
// Whether two sets of pairs agree to the bit.
#pragma once

#include <algorithm>

#include "nysalt/flow_map_data.hpp"
#include "rounding.hpp"

namespace nysalt::test {

inline bool same_bits(const flow_map_data& a, const flow_map_data& b) {
  const auto same_check = [](const auto& x, const auto& y) {
    return x.first == y.first && same_bits(x.second, y.second);
  };
  return a.start == b.start && a.finish == b.finish &&
         std::equal(a.finer.begin(), a.finer.end(), b.finer.begin(), b.finer.end(), same_check) &&
         a.first_of == b.first_of && a.noise == b.noise && a.evaluations == b.evaluations &&
         a.energies->low == b.energies->low && a.energies->high == b.energies->high;
}

}  // namespace nysalt::test
