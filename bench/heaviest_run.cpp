// SPDX-License-Identifier: BSL-1.0
// The heaviest run of [li_lu_tao_ye_2023], 10^4 trajectories of a chain in a bath over a time of 40 in steps
// of 1e-4, and what a learned step makes of it. As users have it: with starts, and with divergence looked
// for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

const in_bath<fpu_chain<3>> chain(fpu_chain<3>(50.0), bath::of_sigma(0.01, 0.05));
constexpr double end_time = 40.0;
constexpr std::int64_t all_trajectories = 10'000;

/// Unobserved. The unit of work is the whole run: it takes so long as the time that is told, whatever share
/// of the trajectories is run.
runner run_of(const std::string& name, const method& method, double step, std::int64_t trajectories,
              int threads) {
  const auto steps = static_cast<std::int64_t>(std::ceil(end_time / step));
  const auto turn = [=] {
    const auto stepper = make_stepper(chain, method, step, counter_noise(1));
    const fpu_law<3> starts(chain);
    const ensemble_options options{
        .trajectories = trajectories, .steps = steps, .every = steps, .execution = {.threads = threads}};
    const auto nothing = [](auto&&...) {};
    const auto diverged_at = integrate_ensemble<pack<double>>(stepper, starts, options, 0, nothing, nothing);
    const auto diverged = [](const auto& step) { return step.has_value(); };
    if (std::any_of(diverged_at.begin(), diverged_at.end(), diverged))
      throw std::runtime_error(fmt::format("{} diverged", name));
  };
  return {name, static_cast<double>(trajectories) / static_cast<double>(all_trajectories), turn};
}

/// One after the other on the same threads.
void race_runs(const std::string& name, std::int64_t trajectories_of_baoab, int threads) {
  const auto learned = member(nystrom(), {0.5248, 0.4155});  // for the step .019
  const auto end = thermostat(learned, placement::end);
  const auto symmetric = thermostat(learned, placement::symmetric);
  std::vector<runner> runners;
  runners.push_back(run_of("BAOAB, step .0001", baoab{}, 1e-4, trajectories_of_baoab, threads));
  runners.push_back(run_of("learned, O at the end, step .019", end, 0.019, all_trajectories, threads));
  runners.push_back(run_of("learned, O symmetric, step .019", symmetric, 0.019, all_trajectories, threads));
  race(name, std::move(runners),
       {.turn_seconds = 0.0,
        .repetitions = 1,
        .clock = threads == 1 ? clock_kind::own_processor : clock_kind::wall});
}

}  // namespace

void race_heaviest_run() {
  constexpr std::int64_t share = 10 * pack<double>::lanes;  // as many for each thread
  race_runs("heaviest run, one thread", share, 1);
  race_runs("heaviest run, two threads", share, 2);
  race_runs("whole heaviest run, one thread", all_trajectories, 1);
  race_runs("whole heaviest run, two threads", all_trajectories, 2);
}

}  // namespace nysalt::bench
