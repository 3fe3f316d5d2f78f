// SPDX-License-Identifier: BSL-1.0
// Saved runs hold the force: OBABO begins a step with a kick by the force that the step before ended with, as
// O moves no position. Of most other words the first force of a step is a new one, whatever was saved.
#include <boost/test/unit_test.hpp>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "nysalt/ensemble_run.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;

namespace {

constexpr std::int64_t trajectories = 3;
constexpr std::int64_t steps = 100;

using samples = std::map<std::pair<std::int64_t, std::int64_t>, double>;  // p1 by trajectory and step

template <class Stepper>
void go_on(ensemble_run<double, Stepper>& run, std::int64_t end, samples& seen) {
  run.go_on(
      end, 5, 1, [](const auto& x, std::span<double> numbers) { numbers[0] = x.p[0]; },
      [&](std::int64_t m, std::int64_t n, std::span<const double> numbers) {
        seen[{m, n}] = numbers[0];
      });
}

/// Saved and taken up again at `cut`, but for what `change` does to the saved numbers; without a cut if it is
/// 0.
samples followed(const tabulated& method, std::int64_t cut, const auto& change) {
  const model system(in_bath(henon_heiles(), bath::of_temperature(0.3, 0.01)));
  const auto stepper = make_stepper(system, method, 0.1, counter_noise(2));
  using run_type = ensemble_run<double, std::remove_const_t<decltype(stepper)>>;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(2);
  const normal_around<Eigen::Dynamic> starts({rest, rest}, 0.1, 0.1);
  samples seen;
  run_type run(stepper, starts, 1, 0, trajectories);
  if (cut == 0) {
    go_on(run, steps, seen);
    return seen;
  }
  go_on(run, cut, seen);
  saved_runs saved = run.save();
  change(saved);
  run_type resumed(stepper, starts, 1, 0, trajectories, saved);
  go_on(resumed, steps, seen);
  return seen;
}

const auto unchanged = [](saved_runs&) {};
const auto without_force = [](saved_runs& saved) {
  for (std::size_t m = 0; m < trajectories; ++m) saved.numbers[6 * m + 4] = saved.numbers[6 * m + 5] = 0.0;
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_run_is_taken_up_with_the_force_it_had) {
  for (const auto& method : {tabulated(obabo()), tabulated(baoab()), tabulated(aboba())}) {
    const samples whole = followed(method, 0, unchanged);
    BOOST_TEST(whole.size() == trajectories * (steps / 5 + 1));
    for (const std::int64_t cut : {5, 7, 64, 99}) {
      BOOST_TEST((followed(method, cut, unchanged) == whole), method.name() << " cut at " << cut);
    }
  }
  // The test can fail: the force is needed.
  BOOST_TEST(!(followed(tabulated(obabo()), 7, without_force) == followed(tabulated(obabo()), 0, unchanged)));
}
