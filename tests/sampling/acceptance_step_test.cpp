// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 1.6 s at -O0, 0.6 s at -O1.
// The acceptance of proposals and the step that has it, against Gaussian targets and against chains.
#include "nysalt/analysis/acceptance_step.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/gaussian_acceptance.hpp"
#include "nysalt/ensembles/gibbs_of_modes.hpp"
#include "nysalt/hmc.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/s_aia.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Independent oscillators of frequencies from 1 to 1.5.
const Eigen::VectorXd frequencies = Eigen::VectorXd::LinSpaced(16, 1.0, 1.5);
const std::span<const double> spectrum(frequencies.data(), 16);
const linear_chain oscillators{frequencies.cwiseAbs2().asDiagonal().toDenseMatrix()};
const model system_of_all(oscillators);
const tabulated by_verlet{verlet{}};

initial_states thermal(double temperature = 1.0) {
  return gibbs_of_modes<Eigen::Dynamic>(oscillators, temperature);
}

acceptance_step step_of(const tabulated& method, double acceptance, double guess,
                        const proposal_options& options) {
  return step_at_acceptance(
      system_of_all, [&](double) { return method; }, acceptance, guess, thermal(options.temperature),
      options);
}

}  // namespace

// Long trajectories have the mean of sin^2, 1/2 but for its end: one part in the phase, 2 pi 100. The second
// moment has mu + mu^2/2 for mu, 2 % at the largest mu here, 0.04, beside what the sample allows.
BOOST_AUTO_TEST_CASE(of_a_gaussian_target_many_times_larger_the_step_is_that_of_its_spectrum) {
  constexpr double larger = 500.0;
  const proposal_options options{.length = 100.0, .times_larger = larger, .states = 400, .seed = seed(1)};
  const double of_part = acceptance_at(energy_error_at(0.9) / larger);
  for (const auto& method : {by_verlet, tabulated(bcss3{})}) {
    const double exact = gaussian_step(method, spectrum, of_part);
    const auto found = step_of(method, 0.9, 0.5 * exact, options);
    BOOST_TEST(!found.is_longest);
    const double relative = standard_errors(false_alarms / 2) * found.log_step.standard_error +
                            0.005;  // a fourth of 2 %, as mu is of h^4
    BOOST_TEST(std::abs(found.step / exact - 1.0) <= relative);
    BOOST_TEST(relative < 0.1);  // sharp enough for what must differ
    const double not_scaled = gaussian_step(method, spectrum, 0.9);
    BOOST_TEST(std::abs(found.step / not_scaled - 1.0) > 5.0 * relative);
    BOOST_TEST(std::accumulate(found.log_of_each.begin(), found.log_of_each.end(), 0.0) / 400.0 ==
                   std::log(found.step),
               boost::test_tools::tolerance(1e-12));
  }
}

// Chains at the step that was found are accepted as often as asked, within what both errors allow. All chains
// have the same durations, 2000 of them, over which the acceptance varies by 0.1 at most.
BOOST_AUTO_TEST_CASE(chains_are_accepted_as_often_as_asked) {
  const proposal_options options{.length = 1.5, .temperature = 0.5, .states = 1600, .seed = seed(1)};
  const auto found = step_of(by_verlet, 0.8, 0.1, options);
  const auto accepted = [&](double step) {
    return hmc(system_of_all, by_verlet, thermal(0.5),
               {.step = step,
                .length = 1.5,
                .temperature = 0.5,
                .chains = 32,
                .burn_in = 0,
                .draws = 2000,
                .seed = seed(1)},
               [](const hmc_draw&) {})
        .acceptance;
  };
  const auto here = acceptance_of_proposals(system_of_all, by_verlet, found.step, thermal(0.5), options);
  const auto of_chains = accepted(found.step);
  const double error = standard_errors(false_alarms) *
                       (here.probability.standard_error + of_chains.standard_error + 0.1 / std::sqrt(2000.0));
  BOOST_TEST(std::abs(here.probability.mean - 0.8) <= 2e-3);
  BOOST_TEST(std::abs(of_chains.mean - 0.8) <= error);
  BOOST_TEST(error < 0.04);
  BOOST_TEST(std::abs(accepted(1.3 * found.step).mean - 0.8) > error);
}

// s_aia3 up to z = h 1.5 ends at h = 4.
BOOST_AUTO_TEST_CASE(a_method_may_depend_on_the_step_and_end) {
  const proposal_options options{.length = 5.0, .states = 64};
  const auto found = step_at_acceptance(
      system_of_all, [](double step) { return tabulated(s_aia3(1.5 * step)); }, 0.5, 1.0, thermal(), options);
  BOOST_TEST(found.step < 4.0);
  BOOST_TEST(found.step > 2.0);
  BOOST_TEST(!found.is_longest);
}

// One oscillator and trajectories of a fifth of a radian: nothing is rejected.
BOOST_AUTO_TEST_CASE(where_all_is_accepted_the_step_is_the_length) {
  const harmonic_oscillator spring(1.0);
  const auto found = step_at_acceptance(model(spring), [](double) { return by_verlet; }, 0.9, 0.01,
                                        gibbs_of_modes<1>(spring, 1.0), {.length = 0.2, .states = 32});
  BOOST_TEST(found.is_longest);
  BOOST_TEST(found.step == 0.2);
}

BOOST_AUTO_TEST_CASE(proposals_that_cannot_be_are_refused) {
  using wrong = std::invalid_argument;
  const auto at = [&](proposal_options options, double step = 0.1) {
    return acceptance_of_proposals(system_of_all, by_verlet, step, thermal(), options);
  };
  BOOST_TEST(refuses<wrong>([&] { at({.length = 0.0}); }, {"length must be positive"}));
  BOOST_TEST(refuses<wrong>([&] { at({.length = 1.0, .times_larger = -1.0}); }, {"times_larger"}));
  BOOST_TEST(refuses<wrong>([&] { at({.length = 1.0}, 1e-9); }, {"at most 1", "take a larger step"}));
  BOOST_TEST(refuses<wrong>([&] { at({.length = 1.0}, -0.1); }, {"step must be positive"}));
  const tabulated one_way("one way", run_time_word("AB"), {1.0, 1.0}, {1, false, false});
  BOOST_TEST(refuses<wrong>([&] { step_of(one_way, 0.9, 0.1, {.length = 1.0}); }, {"must be reversible"}));
  for (const double acceptance : {0.0, 1.0}) {
    BOOST_TEST(
        refuses<wrong>([&] { step_of(by_verlet, acceptance, 0.1, {.length = 1.0}); }, {"between 0 and 1"}));
  }
  // No word of wrong order keeps the energy of a part of 1e30.
  BOOST_TEST(refuses<std::runtime_error>(
      [&] { step_of(by_verlet, 0.9, 1.0, {.length = 5.0, .times_larger = 1e30, .states = 8}); },
      {"must be one that a step down to"}));
}
