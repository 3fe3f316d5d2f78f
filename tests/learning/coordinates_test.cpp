// SPDX-License-Identifier: BSL-1.0
// What is learned depends on the coordinates in which errors are weighed: in the modes of the FPU chain the
// stiff ones decide, and its optimum is nearly that of a linear oscillator; in q and p it is another.
#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(in_the_modes_the_optimum_is_closer_to_the_linear_one) {
  const fpu_chain<3> chain(50.0);
  const fpu_law<3> law(chain);
  // beta1 of the linear optimum in the energy norm at z = 50 step; b1 = 1/2.
  for (const auto& [step, beta1] :
       std::initializer_list<std::pair<double, double>>{{.01, .402726524}, {.02, .400581831}}) {
    const auto data =
        make_flow_map_data(chain, law, fine_steps<>(5e-4), {.step = step, .horizon = 1.0, .seed = 1});
    const auto held_out =
        make_flow_map_data(chain, law, fine_steps<>(5e-4), {.step = step, .horizon = 1.0, .seed = 2});
    const auto by_qp = learn(nystrom{}, chain, data, held_out, {.loss = loss_named("state:1")});
    const auto by_modes = learn(nystrom{}, chain, data, held_out,
                                {.coordinates = coordinates::modes, .loss = loss_named("state:1")});
    BOOST_TEST_CONTEXT(by_qp.summary.full() << by_modes.summary.full()) {
      const auto distance = [&, b = beta1](const learned<nystrom>& fit) {
        return std::hypot(fit.method.parameters()[0] - 0.5, fit.method.parameters()[1] - b);
      };
      BOOST_TEST_MESSAGE("step " << step << ": qp " << by_qp.summary.brief() << "\nmodes "
                                 << by_modes.summary.brief());
      BOOST_TEST(by_qp.summary.coordinates == "qp");
      BOOST_TEST(by_modes.summary.coordinates == "modes");
      // Far enough apart that the errors of both fits, below 1e-3, cannot have done it.
      BOOST_TEST(distance(by_modes) + 3e-3 < distance(by_qp));
    }
  }
}
