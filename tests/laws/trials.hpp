// SPDX-License-Identifier: BSL-1.0
// A law about runs is tried on random states of several systems, at a gentle step.
#pragma once

#include "method_laws.hpp"
#include "models.hpp"

namespace nysalt::test {

/// Calls f(system, method, step, x) for each system of the list.
template <class List>
void try_on_method(const auto& method, auto&& f) {
  draws random;
  for_each<List>([&]<class Model>() {
    const auto system = Model::make();
    const auto x = random.state(system, Model::reach);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << " on " << describe(system)) {
      f(system, method, gentle_step(shears_at(system, x)), x);
    }
  });
}

/// Calls f(system, method, step, x) for each system of the list that the method fits.
template <Method M, class List>
void try_on(auto&& f) {
  draws random;
  for_each<List>([&]<class Model>() {
    if constexpr (fits<M, Model>) {
      const auto system = Model::make();
      const auto method = any_method<M>(random);
      const auto x = random.state(system, Model::reach);
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << " on " << describe(system)) {
        f(system, method, gentle_step(shears_at(system, x)), x);
      }
    }
  });
}

/// Calls f(system, method, x) five times for each of all systems that the method fits.
template <Method M>
void try_on_all(auto&& f) {
  draws random;
  for_each<systems>([&]<class Model>() {
    if constexpr (fits<M, Model>) {
      const auto system = Model::make();
      for (int n = 0; n < 5; ++n) {
        const auto method = any_method<M>(random);
        const auto x = random.state(system, Model::reach);
        BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << describe(system) << ", draw " << n) {
          f(system, method, x);
        }
      }
    }
  });
}

/// Masses and a dynamic dimension, and neither.
using two_systems = std::tuple<a_free_chain, a_galaxy>;

}  // namespace nysalt::test
