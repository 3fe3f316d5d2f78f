// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/noise.hpp"

namespace nysalt {

/// A noise source for runs without noise: no letter O, or a bath with sigma = 0. A stepper refuses it
/// otherwise.
struct no_noise {
  static constexpr bool is_memoryless = false;

  template <class T, int N>
  void normals(const noise_place&, vector<T, N>&) const {}
};

}  // namespace nysalt
