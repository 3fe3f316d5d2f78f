// SPDX-License-Identifier: BSL-1.0
// A black box with memory whose energies several threads ask for: trial runs and error measures share the
// system that they were given, and step copies of their own.
#include <boost/test/unit_test.hpp>

#include <vector>

#include "nysalt/analysis/error_measures/energy.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/trial_run.hpp"
#include "support/with_memory.hpp"

using namespace nysalt;

namespace {

using system_of_trials = test::with_memory<struct trials>;
using system_of_measures = test::with_memory<struct measures>;
using unprotected = test::with_memory<struct by_itself>;
using point = phase_point<double, Eigen::Dynamic>;
const point rest{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)};

}  // namespace

BOOST_AUTO_TEST_CASE(trial_runs_of_a_black_box_with_memory) {
  const model system{system_of_trials()};
  phase_points starts;
  for (int n = 0; n < 64; ++n) {
    starts.push_back(point{Eigen::VectorXd::Constant(1, 1.0 + n), Eigen::VectorXd::Zero(1)});
  }
  const trial_result found =
      trial_run(system, tabulated(verlet{}), 0.1, starts, {.steps = 700, .threads = 4});
  BOOST_TEST(found.objection() == "");
  BOOST_TEST(found.energy_was_watched);
  BOOST_TEST(system_of_trials::meetings == 0);
}

BOOST_AUTO_TEST_CASE(energies_as_a_measure_of_a_black_box_with_memory) {
  const model system{system_of_measures()};
  const auto found = trajectory_errors(
      system, fine_steps<>(0.01), normal_around<Eigen::Dynamic>(rest, 1.0, 1.0), std::vector{verlet{}},
      energy_measure(system), {.step = 0.1, .steps = 20, .trajectories = 64, .threads = 4});
  BOOST_TEST(found.methods[0].error.mean > 0.0);
  BOOST_TEST(system_of_measures::meetings == 0);
}

// The count can fail: one object that several threads use without a model.
BOOST_AUTO_TEST_CASE(without_a_model_threads_meet) {
  const unprotected one;
  for_each_block(64, 1, 4, [&](std::int64_t, int) {
    for (int n = 0; n < 1000; ++n) one.potential(vector<double, 1>(2.0));
  });
  BOOST_TEST(unprotected::meetings > 0);
}
