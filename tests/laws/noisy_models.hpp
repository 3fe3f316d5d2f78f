// SPDX-License-Identifier: BSL-1.0
// Systems in baths and methods with letters O, for what the laws of noisy runs are tried on.
#pragma once

#include "models.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/systems/in_bath.hpp"

namespace nysalt::test {

struct a_warm_fpu : within_a_half {
  static auto make() { return in_bath(an_fpu_chain::make(), bath::of_temperature(0.3, 0.02)); }
};
/// With masses, and of dynamic dimension.
struct a_warm_free_chain : within_one {
  static auto make() { return in_bath(free_chain(), bath::of_sigma(0.4, 0.3)); }
};

using noisy_systems = std::tuple<a_warm_fpu, a_warm_free_chain>;

/// Any word, with a whole step shared equally by the letters of each kind.
template <Flow... L>
struct shared_equally {
  using word = nysalt::word<L...>;
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return "the word " + word::letters(); }
  static std::array<double, word::length> coefficients() {
    const std::string letters = word::letters();
    std::array<double, word::length> c{};
    for (std::size_t i = 0; i < c.size(); ++i) {
      c[i] = 1.0 / static_cast<double>(std::count(letters.begin(), letters.end(), letters[i]));
    }
    return c;
  }
};

using O = ornstein_uhlenbeck;
}  // namespace nysalt::test
