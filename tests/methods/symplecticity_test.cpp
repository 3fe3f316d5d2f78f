// SPDX-License-Identifier: BSL-1.0
// Every method is symplectic, by its exact Jacobian, or keeps volume at least and says so.
#include <boost/test/unit_test.hpp>

#include "../laws/trials.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(steps_are_symplectic, Model, various_systems) {
  try_all_methods<Model>([](const auto& system, const auto& method, const auto& x) {
    if (method.letters().is_symplectic) {
      BOOST_TEST(symplecticity_broken(system, method, x) <= 1.0);
    } else {
      BOOST_TEST(volume_broken(system, method, x) <= 1.0);
    }
  });
}
