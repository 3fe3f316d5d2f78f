// expect: nysalt: a letter that a system declares must be invertible and reversible, as exact_flow states;
//   step the word by its type
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/plugin.hpp"
#include "nysalt/systems/pendulum.hpp"

struct own_drift : nysalt::exact_flow<'a'> {
  static void apply(const auto&, const auto&, auto&, auto&) {}
#ifndef NYSALT_CONTROL
  // [mistake]
  static constexpr bool reversible = false;
  // [/mistake]
#endif
};

struct swing : nysalt::pendulum {};
NYSALT_SYSTEM(swing, "a pendulum", letters<own_drift>(), starts([](const swing&) {
                return normal_around<1>({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.1, 0.1);
              }));
