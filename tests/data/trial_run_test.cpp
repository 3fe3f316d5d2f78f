// SPDX-License-Identifier: BSL-1.0
// A trial run finds what linear criteria do not: trajectories that diverge, and energies that drift.
#include "nysalt/trial_run.hpp"

#include "../support/refusal.hpp"
#include "nysalt/core.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <int N>
std::vector<phase_point<double, N>> starts_of(const auto& law, std::uint64_t count) {
  std::vector<phase_point<double, N>> result;
  for (std::uint64_t n = 0; n < count; ++n) result.push_back(law(7, n));
  return result;
}

const model chain = phi4_chain<>(16);
Eigen::VectorXd numbers(double x) { return Eigen::VectorXd::Constant(16, x); }
const auto chain_starts =
    starts_of<Eigen::Dynamic>(normal_around<Eigen::Dynamic>({numbers(0.0), numbers(0.0)}, 0.5, 1.0), 32);
phase_point<double, 2> at(double q, double p) { return {{0.0, q}, {0.0, p}}; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_far_below_the_limit_passes_and_one_above_it_loses_trajectories) {
  const auto sound = trial_run(chain, tabulated(mclachlan2{}), 0.2, chain_starts, {.steps = 5000});
  BOOST_TEST_CONTEXT(sound.report()) {
    BOOST_TEST(sound.passed());
    BOOST_TEST(sound.objection().empty());
    BOOST_TEST(sound.trajectories == 32);
    BOOST_TEST(sound.steps == 5000);
    BOOST_TEST(sound.energy_was_watched);
    BOOST_TEST(sound.deviation >= sound.first_deviation);
  }
  // z = 2.4 at the frequency that a mass has at rest among others: linearly stable, limit 2.553.
  const auto lost = trial_run(chain, tabulated(mclachlan2{}), 0.65, chain_starts, {.steps = 5000});
  BOOST_TEST_CONTEXT(lost.report()) {
    BOOST_TEST(!lost.passed());
    BOOST_REQUIRE(lost.lost.has_value());
    BOOST_TEST(lost.diverged > 5);
    BOOST_TEST(lost.lost->step < 5000);
    BOOST_TEST(lost.objection().find("diverge") != std::string::npos);
  }
}

// The standard map: beyond h = sqrt(.9716) no invariant circle is left [greene_1979].
BOOST_AUTO_TEST_CASE(an_energy_that_diffuses_is_found_where_nothing_diverges) {
  const normal_around<1> law({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 1.5, 1.5);
  const auto starts = starts_of<1>(law, 64);
  const auto below = trial_run(pendulum{}, tabulated(verlet{}), 0.7, starts, {.steps = 20'000});
  const auto beyond = trial_run(pendulum{}, tabulated(verlet{}), 1.3, starts, {.steps = 20'000});
  BOOST_TEST(below.passed(), below.report());
  BOOST_TEST(!beyond.passed(), beyond.report());
}

// Where a method is exact there is rounding alone, which grows with the steps and is no drift.
BOOST_AUTO_TEST_CASE(rounding_is_no_drift) {
  const linear_chain one(Eigen::MatrixXd::Constant(1, 1, 4.0));
  const std::vector starts{phase_point<double, Eigen::Dynamic>{numbers(1.0).head(1), numbers(0.3).head(1)}};
  const tabulated rotation("rotation", run_time_word("RSR"), {0.5, 1.0, 0.5}, {2, true, true});
  const auto exact = trial_run(one, rotation, 0.7, starts, {.steps = 20'000});
  BOOST_TEST(exact.passed(), exact.report());
  BOOST_TEST(exact.deviation < 1e-9);
}

// Above H = 1/6 the motion of Henon and Heiles may leave through a gap of the potential: no method is to
// blame.
BOOST_AUTO_TEST_CASE(motion_that_is_not_confined_is_left_out) {
  const std::vector starts{at(0.0, 0.3), at(0.0, 0.8)};
  const auto left = trial_run(henon_heiles{}, tabulated(verlet{}), 0.05, starts, {.steps = 5000});
  BOOST_TEST(left.unconfined == 1);
  BOOST_TEST(left.passed(), left.report());
  // At a step beyond the window the confined one is lost as well, and that counts.
  const auto lost = trial_run(henon_heiles{}, tabulated(verlet{}), 2.1, starts, {.steps = 5000});
  BOOST_TEST(lost.diverged == 1);
  BOOST_TEST(!lost.passed());
  // A trial of which nothing is left is not passed.
  const std::vector outside{at(3.0, 0.0), at(3.0, 0.0)};
  const auto trial = trial_run(henon_heiles{}, tabulated(verlet{}), 0.1, outside, {.steps = 5000});
  BOOST_TEST(trial.unconfined == 2);
  BOOST_TEST(trial.kept() == 0);
  BOOST_TEST(!trial.passed());
  BOOST_TEST(trial.report().find("not confined") != std::string::npos, trial.report());
}

// An accurate method in parts of such a step is unstable itself: that tells nothing of the motion.
BOOST_AUTO_TEST_CASE(what_an_accurate_method_cannot_follow_is_not_left_out) {
  const normal_around<1> law({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 1.0, 1.0);
  for (const double omega : {300.0, 1e5}) {  // in 30 parts, and in too many
    const auto trial =
        trial_run(harmonic_oscillator(omega), tabulated(verlet{}), 0.1, starts_of<1>(law, 8), {.steps = 400});
    BOOST_TEST(!trial.passed());
    BOOST_TEST(trial.unconfined == 0);
    BOOST_TEST(trial.diverged == 8);
  }
}

// Starts are run 64 at a time: the first of the second block is the only one that moves too fast for the
// step.
BOOST_AUTO_TEST_CASE(starts_beyond_the_first_block_are_tried) {
  const auto point = [](double q) { return phase_point<double, Eigen::Dynamic>{numbers(q), numbers(0.1)}; };
  std::vector<phase_point<double, Eigen::Dynamic>> starts(64, point(0.1));
  BOOST_TEST(trial_run(chain, tabulated(mclachlan2{}), 0.2, starts, {.steps = 500}).passed());
  starts.push_back(point(20.0));  // sqrt(3) 20 h = 7, far beyond 2.553
  const auto trial = trial_run(chain, tabulated(mclachlan2{}), 0.2, starts, {.steps = 500});
  BOOST_TEST(trial.trajectories == 65);
  BOOST_TEST(trial.diverged == 1);
  BOOST_TEST(trial.unconfined == 0);
  BOOST_REQUIRE(trial.lost.has_value());
  BOOST_TEST(trial.lost->trajectory == 64);
  BOOST_TEST(!trial.passed());
}

BOOST_AUTO_TEST_CASE(in_a_bath_only_divergence_counts) {
  const in_bath warm(harmonic_oscillator(1.0), bath::of_temperature(0.1, 1.0));
  const std::vector<phase_point<double, 1>> starts{{vector<double, 1>(1.0), vector<double, 1>(0.0)}};
  const auto sound = trial_run(warm, tabulated(baoab{}), 0.5, starts, {.steps = 5000});
  BOOST_TEST(sound.passed(), sound.report());
  BOOST_TEST(!sound.energy_was_watched);
  BOOST_TEST(!trial_run(warm, tabulated(baoab{}), 2.2, starts, {.steps = 5000}).passed());
}

BOOST_AUTO_TEST_CASE(no_steps_are_refused) {
  BOOST_TEST(refuses<std::invalid_argument>(
      [] { trial_run(chain, tabulated(verlet{}), 0.1, chain_starts, {.steps = -1}); }, {"-1"}));
}
