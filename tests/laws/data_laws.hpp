// SPDX-License-Identifier: BSL-1.0
// A method by its type and the same method as data are one: what lets the other laws be tried on data alone.
#pragma once

#include "run_laws.hpp"
#include "trials.hpp"

namespace nysalt::test {

/// Runs, looks, a cut and a plain step have the same bits; and evaluations are counted as both declare.
template <Method M, class List>
void try_as_data() {
  using W = typename M::word;
  try_on<M, List>([](const auto& system, const auto& method, double step, const auto& x) {
    const tabulated as_data(method);
    BOOST_TEST(as_data.order == method.order);
    BOOST_TEST(as_data.symmetric == method.symmetric);
    const auto expected = integrate(system, method, step, x, 200).finish;
    BOOST_TEST(same_bits(integrate(system, as_data, step, x, 200).finish, expected));
    BOOST_TEST(same_bits(cut_finish(system, method, step, x, 200, 77), expected));
    BOOST_TEST(same_bits(observed_finish(system, method, step, x, 200, 3), expected));
    auto plain = x;
    auto plain_as_data = x;
    make_stepper(system, method, step).step(plain);
    make_stepper(system, as_data, step).step(plain_as_data);
    BOOST_TEST(same_bits(plain_as_data, plain));
    BOOST_TEST(evaluations_of_run(system, method, step, x, 17) ==
               W::evaluations_to_open + 17 * W::evaluations_per_step);
    BOOST_TEST(evaluations_of_step(system, method, step, x) == W::evaluations_of_plain_step);
    // Another table takes other steps: the comparison can tell.
    auto changed = as_data.coefficients();
    changed.front() += 1e-9;
    const tabulated another("another", as_data.letters(), changed, as_data);
    BOOST_TEST(!same_bits(integrate(system, another, step, x, 200).finish, expected));
  });
}

/// Of a fixed dimension, with masses, and split, so that it has every letter.
using one_system = std::tuple<two_split_weights>;

}  // namespace nysalt::test
