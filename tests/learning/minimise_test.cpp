// SPDX-License-Identifier: BSL-1.0
// The search ends where it ends with a Ceres block for each sample, whatever the family.
#include "nysalt/learning/minimise.hpp"

#include "../support/families.hpp"
#include "../support/systems.hpp"
#include "compare_searches.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(with_two_parameters_and_with_one_of_them) {
  const fpu_chain<3> chain(50.0);
  const fpu_law<3> law(chain);
  compare_searches<nystrom>(chain, law, fine_steps<>(1e-3), 0.02, {0, 1});
  compare_searches<nystrom>(chain, law, fine_steps<>(1e-3), 0.02, {1});
}

BOOST_AUTO_TEST_CASE(with_one_parameter_and_with_three) {
  const dynamic_potential ring;
  compare_searches<aba2>(ring, around_rest(ring), fine_steps<>(0.02), 0.8, {0});
  compare_searches<aba4>(ring, around_rest(ring), fine_steps<>(0.02), 0.8, {0, 1, 2});
}
