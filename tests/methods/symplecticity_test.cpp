// SPDX-License-Identifier: BSL-1.0
// Every method is symplectic, by its exact Jacobian.
#include <boost/test/unit_test.hpp>

#include "../laws/method_laws.hpp"
#include "../laws/models.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(steps_are_symplectic, M, methods) {
  draws random;
  for_each<systems>([&]<class Model>() {
    if constexpr (fits<M, Model>) {
      const auto system = Model::make();
      for (int n = 0; n < 5; ++n) {
        const auto method = any_method<M>(random);
        const auto x = random.state(system, Model::reach);
        BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << describe(system) << ", draw " << n) {
          BOOST_TEST(symplecticity_broken(system, method, x) <= 1.0);
        }
      }
    }
  });
}
