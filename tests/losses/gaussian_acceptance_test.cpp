// SPDX-License-Identifier: BSL-1.0
// The loss gaussian_acceptance: its value, its gradient, and what is learned by it without data.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/gaussian_acceptance.hpp"
#include "nysalt/ensembles/gibbs_of_modes.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/bab.hpp"
#include "nysalt/families/fd_chin.hpp"
#include "nysalt/families/free_composition.hpp"
#include "nysalt/families/r_aba.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/kepler.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/pendulum.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// n frequencies of the logarithmic normal law: its quantiles at (k + 1/2)/n, by bisection.
std::vector<double> spread_frequencies(int n, double deviation) {
  std::vector<double> all;
  for (int k = 0; k < n; ++k) {
    double low = -8.0;
    double high = 8.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (0.5 * std::erfc(-middle / std::numbers::sqrt2) < (k + 0.5) / n ? low : high) = middle;
    }
    all.push_back(std::exp(deviation * low));
  }
  return all;
}

/// A system of independent oscillators.
linear_chain oscillators(const std::vector<double>& frequencies) {
  Eigen::VectorXd squares(std::ssize(frequencies));
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const double omega = frequencies[static_cast<std::size_t>(i)];
    squares[i] = omega * omega;
  }
  return linear_chain(squares.asDiagonal(), Eigen::VectorXd::Ones(squares.size()));
}

const loss_kind& kind() { return *loss_named("gaussian_acceptance").kind; }

template <class F>
objective loss_of(const F& family, const model& system, double step) {
  return kind().without_data(system, run_time_family(family), step);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_loss_is_the_expected_energy_error) {
  const linear_chain chain = linear_chain::between_walls(5, 3.0);
  const Eigen::VectorXd modes = chain.modes().frequencies;
  const std::vector<double> frequencies(modes.begin(), modes.end());
  const auto loss = loss_of(bab<3>{}, chain, 0.4);
  const auto theta_of = [](const auto& method) {
    const auto c = method.coefficients();
    return Eigen::VectorXd(Eigen::Vector2d(c[0], c[1]));
  };
  const double expected = gaussian_energy_error(tabulated(bcss3{}), frequencies, 0.4);
  // Sums of five terms, each right to some hundred roundings over z^2, the least 1.2.
  BOOST_TEST(loss(theta_of(bcss3{})).value == expected, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(std::abs(loss(theta_of(predescu3{})).value / expected - 1.0) > 1e-2);
}

BOOST_AUTO_TEST_CASE(the_gradient_is_the_slope) {
  const linear_chain chain = linear_chain::between_walls(5, 3.0);
  const auto loss = loss_of(bab<4>{}, chain, 0.5);
  const Eigen::VectorXd theta = Eigen::Vector3d(0.08, 0.2, 0.26);
  const auto at = loss(theta);
  for (Eigen::Index k = 0; k < 3; ++k) {
    constexpr double change = 1e-5;  // its square, and rounding over it, are below 1e-9
    Eigen::VectorXd above = theta;
    Eigen::VectorXd below = theta;
    above[k] += change;
    below[k] -= change;
    const double slope = (loss(above).value - loss(below).value) / (2.0 * change);
    BOOST_TEST(std::abs(slope - at.gradient()[k]) <= 1e-6 * std::abs(at.gradient()[k]) + 1e-9);
    BOOST_TEST(std::abs(slope - 2.0 * at.gradient()[k]) > 1e-3 * std::abs(slope));
  }
}

// Below z = h omega = 4 the word of four equal steps is stable, beyond 8 none.
BOOST_AUTO_TEST_CASE(where_a_word_is_not_stable_the_loss_is_infinite) {
  const Eigen::VectorXd equal = Eigen::Vector3d(0.125, 0.25, 0.25);
  BOOST_TEST(std::isfinite(loss_of(bab<4>{}, harmonic_oscillator(1.0), 3.9)(equal).value));
  BOOST_TEST(std::isinf(loss_of(bab<4>{}, harmonic_oscillator(1.0), 8.1)(equal).value));
}

// Bands without modes: the mean over frequencies of the band. The points of a band are 16.
BOOST_AUTO_TEST_CASE(bands_count_where_there_are_no_modes) {
  const auto bands = pendulum().frequency_bands();
  std::vector<double> frequencies;
  for (const auto& [low, high] : bands) {
    for (int k = 0; k < 16; ++k) frequencies.push_back(low + (high - low) * (k + 0.5) / 16.0);
  }
  const double mean =
      gaussian_energy_error(tabulated(bcss3{}), frequencies, 0.5) / static_cast<double>(frequencies.size());
  const auto c = bcss3::coefficients();
  const auto loss = loss_of(bab<3>{}, pendulum(), 0.5);
  BOOST_TEST(loss(Eigen::Vector2d(c[0], c[1])).value == mean, boost::test_tools::tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(what_has_no_spectrum_or_no_plain_word_is_refused) {
  using wrong = std::invalid_argument;
  const linear_chain chain = linear_chain::between_walls(3, 3.0);
  BOOST_TEST(refuses<wrong>([] { loss_of(bab<3>{}, kepler(), 0.1); }, {"must declare frequencies"}));
  BOOST_TEST(refuses<wrong>([&] { loss_of(aba3_free{}, chain, 0.1); }, {"must be symmetric"}));
  BOOST_TEST(refuses<wrong>([&] { loss_of(r_aba<2>{}, chain, 0.1); }, {"must be symmetric"}));
  BOOST_TEST(std::isfinite(loss_of(fd_chin{}, chain, 0.1)(Eigen::Vector2d(1.0 / 6.0, 1.0 / 24.0)).value));
}

// A spread spectrum: 40 of its frequencies stand for all of 10,000 dimensions, so that at the acceptance 0.9
// of these the 40 have a 250th of the energy error.
BOOST_AUTO_TEST_CASE(what_is_learned_takes_larger_steps_than_all_formulas) {
  constexpr double dimensions = 1e4;
  const auto frequencies = spread_frequencies(40, 0.02);
  const double acceptance = acceptance_at(energy_error_at(0.9) * 40.0 / dimensions);
  const auto step_of = [&](const tabulated& method, double from = 0.0) {
    return nysalt::gaussian_step(method, frequencies, acceptance, from) /
           method.letters().evaluations_per_step;
  };
  double best = 0.0;
  for (const auto& rival : {tabulated(verlet{}), tabulated(mclachlan2v{}), tabulated(bcss3{}),
                            tabulated(predescu3{}), tabulated(bcss4{}), tabulated(omelyan5v{})}) {
    best = std::max(best, step_of(rival));
  }
  const linear_chain target = oscillators(frequencies);
  const double step = 4.0 * 1.25 * best;
  const gibbs_of_modes<Eigen::Dynamic> law(target, 1.0);
  const data_options training{.step = step, .horizon = 2.0 * step, .trajectories = 8};
  data_options others = training;
  others.seed = 2;
  const auto data = make_flow_map_data(target, law, exact_linear(target), training);
  const auto unseen = make_flow_map_data(target, law, exact_linear(target), others);
  const auto [method, fit] =
      learn(bab<4>{}, target, data, unseen, {.loss = loss_named("gaussian_acceptance")});
  BOOST_TEST(fit.usable, fit.reason);
  BOOST_TEST(fit.loss_name == "gaussian_acceptance");
  BOOST_TEST(!fit.is_of_data);
  const double learned = step_of(tabulated(method.anywhere()), step);
  BOOST_TEST(learned > 1.15 * best, learned << " and " << best);
  BOOST_TEST(learned < 1.5 * best);
}
