// SPDX-License-Identifier: BSL-1.0
// The same system, stepped in another number of lanes.
#pragma once

#include "nysalt/lanes.hpp"

namespace nysalt::test {

template <class S, int L>
struct in_lanes : S {
  static constexpr int lanes = L;
  explicit in_lanes(const S& system) : S(system) {}
};

}  // namespace nysalt::test
