// SPDX-License-Identifier: BSL-1.0
// Whether two sets of pairs agree to the bit.
#pragma once

#include <algorithm>

#include "nysalt/flow_map_data.hpp"
#include "rounding.hpp"

namespace nysalt::test {

template <int N>
bool same_bits(const flow_map_data<N>& a, const flow_map_data<N>& b) {
  using state = phase_point<double, N>;
  const auto same = [](const state& x, const state& y) { return same_bits(x, y); };
  const auto same_check = [](const auto& x, const auto& y) {
    return x.first == y.first && same_bits(x.second, y.second);
  };
  return std::equal(a.start.begin(), a.start.end(), b.start.begin(), b.start.end(), same) &&
         std::equal(a.finish.begin(), a.finish.end(), b.finish.begin(), b.finish.end(), same) &&
         std::equal(a.finer.begin(), a.finer.end(), b.finer.begin(), b.finer.end(), same_check) &&
         a.first_of == b.first_of && a.noise == b.noise && a.evaluations == b.evaluations &&
         a.energies->low == b.energies->low && a.energies->high == b.energies->high;
}

}  // namespace nysalt::test
