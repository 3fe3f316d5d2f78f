// SPDX-License-Identifier: BSL-1.0
// The search ends where it ends with a Ceres block for each sample, whatever the system.
#include "../support/systems.hpp"
#include "compare_searches.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(of_masses) {
  compare_searches<nystrom>(two_masses(), around_rest(two_masses()), fine_steps<>(0.02), 0.6, {0, 1});
}
BOOST_AUTO_TEST_CASE(of_another_kinetic_energy) {
  const auto starts = around_rest(relativistic());
  compare_searches<nystrom>(relativistic(), starts, fine_steps<srkn6b>(0.01), 0.8, {0, 1});
}
BOOST_AUTO_TEST_CASE(of_a_black_box) {
  compare_searches<nystrom>(black_box(), around_rest(black_box()), fine_steps<>(0.02), 0.8, {0, 1});
}
