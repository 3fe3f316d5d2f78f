// SPDX-License-Identifier: BSL-1.0
// At the step .04 the stiff springs move beyond Verlet's stability limit, and the learned method goes on.
#include <boost/test/unit_test.hpp>

#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;

BOOST_AUTO_TEST_CASE(verlet_diverges_on_every_trajectory_and_the_learned_method_on_none) {
  constexpr double step = .04;
  constexpr std::int64_t steps = 3750;  // to T = 150
  const fpu_chain<3> system(50.0);
  const fpu_law<3> law(system);
  const fine_steps<> reference(2.5e-4);
  const auto data = make_flow_map_data(system, law, reference, {.step = step, .seed = 1});
  const auto held_out = make_flow_map_data(system, law, reference, {.step = step, .seed = 2});
  const auto fit = learn(nystrom{}, system, data, held_out);
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    BOOST_TEST(fit.summary.usable);
    for (std::uint64_t m = 0; m < 200; ++m) {
      const auto start = law(3, m);
      const auto by_verlet = integrate(system, verlet(), step, start, steps);
      BOOST_TEST_CONTEXT("trajectory " << m) {
        BOOST_REQUIRE(by_verlet.diverged_at.has_value());
        BOOST_TEST(*by_verlet.diverged_at > 0);
        BOOST_TEST(*by_verlet.diverged_at <= steps);
        BOOST_TEST(by_verlet.steps == *by_verlet.diverged_at);
        const auto by_learned = integrate(system, fit.method, step, start, steps);
        BOOST_TEST(!by_learned.diverged_at.has_value());
        BOOST_TEST(by_learned.steps == steps);
      }
    }
  }
}
