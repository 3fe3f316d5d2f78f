// SPDX-License-Identifier: BSL-1.0
// Whether two passes over data came to the same bits.
#pragma once

#include "nysalt/losses/squares.hpp"

namespace nysalt::test {

inline bool same(const squares& a, const squares& b) {
  return a.value == b.value && a.half_gradient == b.half_gradient && a.normal_matrix == b.normal_matrix;
}

}  // namespace nysalt::test
