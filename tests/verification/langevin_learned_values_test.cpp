// SPDX-License-Identifier: BSL-1.0
// What is learned for the FPU chain in the paper's bath, gamma = .01 and sigma = .05.
#include <boost/test/unit_test.hpp>

#include "../support/thermal_starts.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/thermostatted.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/systems/fpu_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using system_type = in_bath<fpu_chain<3>>;
const fpu_chain<3> alone(50.0);
const system_type chain(alone, bath::of_sigma(0.01, 0.05));
const auto starts = thermal_starts(alone, chain.bath().temperature(), 512, 1);
const auto other_starts = thermal_starts(alone, chain.bath().temperature(), 512, 2);

using family = thermostatted_family<nystrom, placement::end>;

learned<family> learn_at(double step, coordinates which) {
  const auto data = [&](const auto& from, std::uint64_t seed) {
    return make_flow_map_data(
        chain, from, fine_paths(1e-4),
        {.step = step, .horizon = 1.0, .trajectories = 512, .seed = seed, .noise_parts = 1});
  };
  return learn(family{}, chain, data(starts, 1), data(other_starts, 2),
               {.coordinates = which, .loss = loss_named("state:1")});
}

struct row {
  double step;
  parameters_of<nystrom> expected;
};
// Measured beforehand by other programs, with other random numbers, in (q, p).
const std::vector<row> known{{.01, {.5146, .4131}}, {.019, {.5248, .4155}}, {.033, {.5265, .4079}}};

}  // namespace

BOOST_AUTO_TEST_CASE(the_parameters_are_the_known_ones) {
  for (const auto& [step, expected] : known) {
    const auto fit = learn_at(step, coordinates::qp);
    const auto theta = fit.method.parameters();
    BOOST_TEST_MESSAGE(fit.summary.full());
    BOOST_TEST_CONTEXT(fit.summary.full()) {
      BOOST_TEST(fit.summary.usable);
      // Ours and theirs scatter by some .002 and .001 with the paths.
      BOOST_TEST(std::abs(theta[0] - expected[0]) <= .006);
      BOOST_TEST(std::abs(theta[1] - expected[1]) <= .003);
    }
  }
}

// The minimum of the loss in the energy norm is that of an oscillator without a bath, as friction is small.
BOOST_AUTO_TEST_CASE(in_modes_the_linear_optimum_is_learned) {
  for (const auto& [step, optimum] : {std::pair(.01, .402727), std::pair(.02, .400582)}) {
    const auto fit = learn_at(step, coordinates::modes);
    BOOST_TEST_MESSAGE(fit.summary.full());
    BOOST_TEST_CONTEXT(fit.summary.full()) {
      BOOST_TEST(fit.summary.usable);
      BOOST_TEST(std::abs(fit.method.parameters()[1] - optimum) <= .002);
    }
  }
}
