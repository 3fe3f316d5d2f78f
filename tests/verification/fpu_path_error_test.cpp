// SPDX-License-Identifier: BSL-1.0
// Errors of the total stiff energy on short trajectories of the FPU chain, learned against Verlet.
#include <boost/test/unit_test.hpp>

#include "nysalt/analysis/path_error.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learner.hpp"
#include "nysalt/methods/verlet.hpp"
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
  std::vector<phase_point<double, 6>> starts;
  for (std::uint64_t m = 0; m < 400; ++m) starts.push_back(law(3, m));
  const auto observable = [&](const auto& x) { return system.stiff_energy(x); };
  for (const auto& expected : known) {
    const auto data = make_flow_map_data(system, law, reference, {.step = expected.step, .seed = 1});
    const auto held_out = make_flow_map_data(system, law, reference, {.step = expected.step, .seed = 2});
    const auto fit = learn(nystrom{}, system, data, held_out);
    const auto steps = static_cast<std::int64_t>(0.5 / expected.step + 1e-9);
    const auto paths = reference_paths(system, reference, expected.step, steps, starts, observable);
    const auto error = [&](const auto& method) {
      const auto result = path_error(system, method, expected.step, starts, paths, observable);
      BOOST_TEST_MESSAGE("step " << expected.step << ", " << method.name() << ": " << result.error.mean
                                 << " +- " << result.error.standard_error);
      BOOST_TEST(result.diverged == 0);
      return result.error.mean;
    };
    BOOST_TEST_CONTEXT("step " << expected.step << ", " << fit.summary.brief()) {
      using boost::test_tools::tolerance;
      BOOST_TEST(fit.summary.usable);
      // Two digits are given (5 %), and each mean has a standard error of 2 to 4 %.
      BOOST_TEST(error(verlet()) == expected.verlet, tolerance(.15));
      BOOST_TEST(error(verlet_2x()) == expected.verlet_2x, tolerance(.15));
      // The learned method is itself random: its parameters have errors, and the optimum is shallow.
      BOOST_TEST(error(fit.method) == expected.learned, tolerance(.25));
    }
  }
}
