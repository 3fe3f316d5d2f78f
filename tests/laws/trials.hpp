// SPDX-License-Identifier: BSL-1.0
// A law about runs is tried on random states of several systems, at a gentle step.
#pragma once

#include "method_laws.hpp"
#include "models.hpp"

namespace nysalt::test {

/// Calls f(system, method, step, x) for each system of the list that suits the method.
template <class List>
void try_on_method(const auto& method, auto&& f) {
  draws random;
  for_each<List>([&]<class Model>() {
    const auto system = Model::make();
    if (!suits(system, method)) return;
    const auto x = random.state(system, Model::reach);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << " on " << describe(system)) {
      f(system, method, gentle_step(shears_at(system, x)), x);
    }
  });
}

/// The same for every method, as data.
template <class List>
void try_all_on(auto&& f) {
  draws random;
  for (const auto& method : methods_as_data(random)) try_on_method<List>(method, f);
}

/// The same for one method by its type, with a random member of a family for each system.
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

/// Calls f(system, method, x) five times, with other members and states, for every method as data on a system
/// that suits it.
template <class Model>
void try_all_methods(auto&& f) {
  draws random;
  const auto system = Model::make();
  for (int n = 0; n < 5; ++n) {
    for (const auto& method : methods_as_data(random)) {
      const auto x = random.state(system, Model::reach);
      if (!suits(system, method)) continue;
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << " on " << describe(system)
                                 << ", draw " << n) {
        f(system, method, x);
      }
    }
  }
}

/// Of a dynamic dimension, and with masses; in potentials that let go of none, and split, so that every
/// method can step them.
using bound_systems = std::tuple<a_split_ring, two_split_weights>;

}  // namespace nysalt::test
