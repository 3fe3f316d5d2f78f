// SPDX-License-Identifier: BSL-1.0
// References conserve the energy of every system.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../laws/system_laws.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(references_conserve_energy, Model, systems) {
  const auto system = Model::make();
  if constexpr (HasEnergy<system_of<Model>>) {
    draws random;
    const auto x = random.state(system, Model::reach);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << describe(system)) {
      // 13 evaluations make a step of an error within the tolerance; a rejected one only adds to the count.
      const double tolerance = 1e-12;
      const double error = tolerance * size_of(x) / 13.0 + 8.0 * eps * size_of(x);
      BOOST_TEST(energy_defect(system, odeint_reference(tolerance), x, 2.0, error) <= 1.0);
      if constexpr (NystromSystem<system_of<Model>>) {
        // SRKN11b at w h = 5e-3 errs by (w h)^7 < 1e-16 a step; each evaluation rounds q and p.
        const double fine = 2.0 / std::ceil(400.0 * shears_at(system, x).frequency());
        BOOST_TEST(energy_defect(system, fine_steps(fine), x, 2.0, 2.0 * eps * size_of(x)) <= 1.0);
        const fine_steps<verlet> coarse(fine * 50.0);  // an honest failure
        const double time = fine * 50.0 * 4.0;
        BOOST_TEST(energy_defect(system, coarse, x, time, 2.0 * eps * size_of(x)) > 1e3);
      }
    }
  }
}
