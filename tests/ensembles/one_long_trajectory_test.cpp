// SPDX-License-Identifier: BSL-1.0
// States of one trajectory: the invariant law if it was burned in, and more if not.
#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/ensembles/one_long_trajectory.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
const fpu_chain<3> chain(50.0);
const fpu_law<3> law(chain);
constexpr double kT = 0.125;
const in_bath in_a_bath(chain, bath::of_temperature(0.1, kT));

std::vector<double> stiff_energies(const auto& ensemble) {
  std::vector<double> result;
  for (std::uint64_t n = 0; n < 10'000; ++n) result.push_back(chain.stiff_energy(ensemble(seed(5), n)));
  return result;
}

}  // namespace

// I forgets in 1/gamma = 10: tau = 20, and of T = 20000 there are 1000 independent samples, of which 10000
// are taken with replacement: as many as 909. Its mean is 3 kT, its variance 3 kT^2 = 0.047 with the relative
// error sqrt(4/909) (kurtosis 5), where momenta have 1 - z^2/4 of their variance, z = omega h = .5, by
// BAOAB's step. A start with I_0 = 40 adds about (I_0 - 3 kT)^2 (10/2)/T = 0.39, eight times that.
BOOST_AUTO_TEST_CASE(without_a_burn_in_the_way_down_stays_in_the_sample) {
  constexpr double of_momenta = 1.0 - 0.25 * 0.5 * 0.5;
  constexpr double expected = 3.0 * kT * 0.5 * (1.0 + of_momenta);
  constexpr double variance = 3.0 * kT * kT * 0.5 * (1.0 + of_momenta * of_momenta);
  constexpr double independent = 909.0;
  const double allowed = standard_errors(false_alarms / 2);
  const double error = std::sqrt(4.0 / independent);
  const vector<double, 6> momenta = chain.modes().basis.col(3) * std::sqrt(80.0);
  const normal_around<6> hot({vector<double, 6>::Zero(), momenta}, 0.0, 0.0);
  const auto seen = [&](double burn_in) {
    return stiff_energies(one_long_trajectory(
        in_a_bath, hot, {.length = 20'000.0 + burn_in, .burn_in = burn_in, .step = 0.01, .seed = seed(1)}));
  };
  const auto raw = seen(0.0);
  const auto burned = seen(200.0);
  BOOST_TEST(covariance(raw, raw) > variance * (1.0 + allowed * error));
  BOOST_TEST(std::abs(covariance(burned, burned) / variance - 1.0) <= allowed * error);
  BOOST_TEST(mean_off(burned, expected, std::sqrt(variance)) * std::sqrt(independent / 10'000.0) <= allowed);
}

BOOST_AUTO_TEST_CASE(a_start_is_a_function_of_seed_and_number_and_one_of_few_states) {
  const in_bath system(harmonic_oscillator(1.0), bath::of_temperature(0.5, 1.0));
  const normal_around<1> start({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 1.0, 1.0);
  const long_trajectory_options options{
      .length = 1000.0, .burn_in = 20.0, .step = 0.5, .most_states = 100, .seed = seed(1)};
  const one_long_trajectory ensemble(system, start, options);
  const one_long_trajectory again(system, start, options);
  BOOST_TEST(ensemble.states() > 50U);
  BOOST_TEST(ensemble.states() <= 100U);
  std::vector<double> seen;
  for (std::uint64_t n = 0; n < 2000; ++n) {
    BOOST_TEST(same_bits(ensemble(seed(1), n), again(seed(1), n)));
    seen.push_back(ensemble(seed(1), n).q[0]);
  }
  BOOST_TEST(ensemble(1, 3).q != ensemble(2, 3).q);
  const std::vector<double> front(seen.begin(), seen.end() - 1);
  const std::vector<double> back(seen.begin() + 1, seen.end());
  BOOST_TEST(std::abs(correlation(front, back)) * std::sqrt(2000.0) <= standard_errors(false_alarms));
  std::sort(seen.begin(), seen.end());
  const auto different = std::unique(seen.begin(), seen.end()) - seen.begin();
  // of 100 states each is missed by 2000 picks with a probability of e^{-20}
  BOOST_TEST(different == static_cast<std::ptrdiff_t>(ensemble.states()));
  BOOST_TEST(ensemble.description().find("one_long_trajectory(length=1000, burn_in=20, step=0.5, seed=" +
                                         std::to_string(seed(1))) == 0U);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto refused = [](const long_trajectory_options& options) {
    return refuses<wrong>([&] { one_long_trajectory(in_a_bath, law, options); },
                          {"one_long_trajectory", "must hold"});
  };
  BOOST_TEST(refused({.length = -1.0}));
  BOOST_TEST(refused({.length = 10.0, .burn_in = 10.0}));
  BOOST_TEST(refused({.burn_in = -1.0}));
  BOOST_TEST(refused({.step = -0.1}));
  BOOST_TEST(refused({.step = 1e-9}));
  BOOST_TEST(refused({.most_states = 0}));
  BOOST_TEST(refused({.most_states = 100'001}));
  BOOST_TEST(refuses<wrong>(
      [] { one_long_trajectory(in_a_bath, law, {.length = 0.1, .burn_in = 0.09, .step = 0.04}); },
      {"must leave a state"}));
}

BOOST_AUTO_TEST_CASE(a_trajectory_that_diverges_is_refused) {
  const in_bath escaping(henon_heiles{}, bath::of_temperature(0.1, 1.0));
  const normal_around<2> start({vector<double, 2>::Zero(), vector<double, 2>::Zero()}, 0.1, 0.1);
  BOOST_TEST(refuses<std::runtime_error>([&] { one_long_trajectory(escaping, start); },
                                         {"diverged at time", "henon_heiles()"}));
}
