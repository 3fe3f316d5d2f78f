// SPDX-License-Identifier: BSL-1.0
// Errors of the total stiff energy along paths of the FPU chain in the paper's bath, on one noise.
#include <boost/test/unit_test.hpp>

#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "../support/thermal_starts.hpp"
#include "nysalt/analysis/error_measures/relative.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/systems/fpu_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using system_type = in_bath<fpu_chain<3>>;
const fpu_chain<3> without_bath(50.0);
const system_type chain(without_bath, bath::of_sigma(0.01, 0.05));

struct row {
  double step;
  parameters_of<nystrom> learned;  // in (q, p), O at the end
  double baoab, end, symmetric;
};
// Measured beforehand by other programs, with other random numbers.
const std::vector<row> known{{.01, {.5146, .4131}, 2.7e-2, 1.93e-2, 9.2e-3},
                             {.019, {.5248, .4155}, .102, 4.1e-2, 2.1e-2}};

}  // namespace

BOOST_AUTO_TEST_CASE(errors_are_the_known_ones) {
  constexpr std::int64_t trajectories = 2048;
  const auto starts = thermal_starts(without_bath, chain.bath().temperature(), trajectories, seed(1));
  const auto stiff_energy = over_lanes([](const auto& x) { return without_bath.stiff_energy(x); });
  for (const auto& [step, theta, of_baoab, of_end, of_symmetric] : known) {
    const member<nystrom> plain(theta);
    const std::array methods{tabulated(baoab()), tabulated(thermostat<placement::end>(plain)),
                             tabulated(thermostat<placement::symmetric>(plain)), tabulated(baoab_2x())};
    const auto steps = static_cast<std::int64_t>(1.0 / step + 1e-9);
    const auto result =
        trajectory_errors(chain, fine_paths(1e-4), starts, methods, relative_measure(chain, stiff_energy),
                          {.step = step, .steps = steps, .trajectories = trajectories, .seed = seed(3)});
    BOOST_TEST_CONTEXT("step " << step) {
      for (const auto& method : result.methods) {
        BOOST_TEST_MESSAGE(method.error.mean << " +- " << method.error.standard_error);
        BOOST_TEST(method.diverged == 0);
        BOOST_TEST(result.reference_error->mean < 0.02 * method.error.mean);
      }
      // Two digits are given (5 %), each mean has a standard error of 1.5 % at most; six means.
      const auto near = boost::test_tools::tolerance(.05 + standard_errors(false_alarms / 6) * .015);
      BOOST_TEST(result.methods[0].error.mean == of_baoab, near);
      BOOST_TEST(result.methods[1].error.mean == of_end, near);
      BOOST_TEST(result.methods[2].error.mean == of_symmetric, near);
      // At the cost of a two-stage method BAOAB takes half the step, and is the better one.
      BOOST_TEST(result.methods[3].error.mean < result.methods[1].error.mean);
    }
  }
}
