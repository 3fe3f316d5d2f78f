// SPDX-License-Identifier: BSL-1.0
// Errors of the total stiff energy on short trajectories of the FPU chain, learned against Verlet.
#include <boost/test/unit_test.hpp>

#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/error_measures/relative.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;

namespace {

struct row {
  double step;
  double verlet, verlet_2x, learned;
};
// Measured beforehand by other programs, with other random numbers.
const std::vector<row> known{{.01, 2.2e-2, 5.4e-3, 3.9e-4}, {.03, .30, 4.2e-2, 5.7e-3}};

}  // namespace

BOOST_AUTO_TEST_CASE(errors_are_the_known_ones) {
  const fpu_chain<3> system(50.0);
  const fpu_law<3> law(system);
  const fine_steps<> reference(2.5e-4);
  const auto measure = relative_measure(system, [&](const auto& x) { return system.stiff_energy(x); });
  for (const auto& expected : known) {
    const auto data =
        make_flow_map_data(system, law, reference, {.step = expected.step, .seed = test::seed(1)});
    const auto held_out =
        make_flow_map_data(system, law, reference, {.step = expected.step, .seed = test::seed(2)});
    const auto fit = learn(nystrom{}, system, data, held_out, {.loss = loss_named("state:1")});
    const auto steps = static_cast<std::int64_t>(0.5 / expected.step + 1e-9);
    const trajectory_options options{
        .step = expected.step, .steps = steps, .trajectories = 1600, .seed = test::seed(3)};
    const auto error = [&](const auto& method) {
      const auto judged = trajectory_errors(system, reference, law, method, measure, options);
      const auto& result = judged.methods[0];
      BOOST_TEST_MESSAGE("step " << expected.step << ", " << method.name() << ": " << result.error.mean
                                 << " +- " << result.error.standard_error);
      BOOST_TEST(result.diverged == 0);
      BOOST_TEST(judged.reference_error->mean < 1e-3 * result.error.mean);
      return result.error.mean;
    };
    BOOST_TEST_CONTEXT("step " << expected.step << ", " << fit.summary.brief()) {
      using boost::test_tools::tolerance;
      BOOST_TEST(fit.summary.usable);
      // Two digits are given (5 %), and each mean has a standard error of 1 to 2 %; six means.
      const double allowed = test::standard_errors(test::false_alarms / 6) * .02;
      BOOST_TEST(error(verlet()) == expected.verlet, tolerance(.05 + allowed));
      BOOST_TEST(error(verlet_2x()) == expected.verlet_2x, tolerance(.05 + allowed));
      // The learned method is itself random: its parameters have errors, and the optimum is shallow.
      BOOST_TEST(error(fit.method) == expected.learned, tolerance(.25));
    }
  }
}
