// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 2.2 s at -O0, 0.8 s at -O1.
// The acceptance of proposals of Hybrid Monte Carlo: in closed form, and along trajectories; and the step
// that has it, against Gaussian targets and against chains.
#include <numeric>

#include "../support/members.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const fpu_chain<3> chain(50.0);
const model of_chain(chain);
const fpu_law<3> law(chain);
const method by_verlet{verlet{}};

/// The mean of min(1, exp(-x)) over x normal of mean mu and variance 2 mu, by the midpoint rule.
double accepted(double mu) {
  constexpr int points = 200'000;
  constexpr double reach = 8.0;  // deviations: beyond lies 1e-15
  const double deviation = std::sqrt(2.0 * mu);
  double sum = 0.0;
  for (int k = 0; k < points; ++k) {
    const double u = reach * (2.0 * (k + 0.5) / points - 1.0);
    const double x = mu + deviation * u;
    sum += std::exp(-0.5 * u * u) * std::min(1.0, std::exp(-x));
  }
  return sum * 2.0 * reach / points / std::sqrt(2.0 * std::numbers::pi);
}

/// K = sqrt(1 + p^2) + tilt p + bend p^3, odd where it must not be.
struct tilted {
  static constexpr int dimension = 2;
  static constexpr int lanes = 1;
  double tilt = 0.0;
  double bend = 0.0;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    return (q[0] * q[0] + q[1] * q[1]) * 0.5;
  }
  template <class T>
  T kinetic_energy(const vector<T, 2>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + p[1] * p[1] + 1.0) + p[1] * tilt + p[1] * p[1] * p[1] * bend;
  }
};

/// Independent oscillators of frequencies from 1 to 1.5.
const Eigen::VectorXd frequencies = Eigen::VectorXd::LinSpaced(16, 1.0, 1.5);
const std::span<const double> spectrum(frequencies.data(), 16);
const linear_chain oscillators{frequencies.cwiseAbs2().asDiagonal().toDenseMatrix()};
const model system_of_all(oscillators);

initial_states thermal(double temperature = 1.0) {
  return gibbs_of_modes<Eigen::Dynamic>(oscillators, temperature);
}

acceptance_step step_of(const method& method, double acceptance, double guess,
                        const proposal_options& options) {
  return step_at_acceptance(
      system_of_all, [&](double) { return method; }, acceptance, guess, thermal(options.temperature),
      options);
}

}  // namespace

// The midpoint rule errs by the jump of the slope at x = 0 times the square of its interval, 8e-5, over 24.
BOOST_AUTO_TEST_CASE(the_acceptance_of_normal_energy_errors_is_the_mean_of_metropolis_rule) {
  for (const double mu : {1e-3, 0.0316, 0.5, 3.0}) {
    BOOST_TEST(std::abs(detail::acceptance_at(mu) - accepted(mu)) <= 1e-9);
    BOOST_TEST(std::abs(detail::acceptance_at(1.001 * mu) - accepted(mu)) > 1e-9);
    BOOST_TEST(energy_error_at(detail::acceptance_at(mu)) == mu, tolerance(1e-11));
  }
  BOOST_TEST(detail::acceptance_at(0.0) == 1.0);
  BOOST_TEST(detail::acceptance_at(infinite) == 0.0);
}

// d oscillators of one frequency and Verlet's method: d z^4/(64 (1 - z^2/4)) = mu is quadratic in z^2. The
// step is found to 1e-9.
BOOST_AUTO_TEST_CASE(the_gaussian_step_of_verlet_is_the_closed_form) {
  const double mu = energy_error_at(0.9);
  for (const int d : {1, 100, 10'000}) {
    const std::vector<double> frequencies(static_cast<std::size_t>(d), 3.0);
    const double a = d / 64.0;
    const double b = mu / 4.0;
    const double closed = std::sqrt((-b + std::sqrt(b * b + 4.0 * a * mu)) / (2.0 * a)) / 3.0;
    const double found = gaussian_step(by_verlet, frequencies, 0.9);
    BOOST_TEST(std::abs(found / closed - 1.0) <= 2e-9);
    BOOST_TEST(std::abs(gaussian_step(by_verlet, frequencies, 0.89) / closed - 1.0) > 1e-3);
    BOOST_TEST(std::abs(gaussian_step(by_verlet, frequencies, 0.9, 5.0 * closed) / closed - 1.0) <= 2e-9);
    // Errors add up over oscillators.
    BOOST_TEST(detail::gaussian_energy_error(by_verlet, frequencies, found) == mu, tolerance(1e-6));
  }
  BOOST_TEST(detail::gaussian_energy_error(by_verlet, std::vector{1.0}, 2.5) == infinite);
}

// What diverged is rejected: a mean of errors would leave it out.
BOOST_AUTO_TEST_CASE(it_is_the_mean_over_trajectories_of_what_integrate_says) {
  for (const double step : {0.03, 0.05}) {
    const trajectory_options options{
        .step = step, .steps = step == 0.03 ? 70 : 3, .trajectories = 37, .seed = 3};
    const auto all = acceptance(chain, by_verlet, law, options, 0.1);
    BOOST_REQUIRE(all.of_each.size() == 37U);
    double sum = 0.0;
    std::size_t lost = 0;
    for (std::uint64_t m = 0; m < 37; ++m) {
      const phase_point<double, Eigen::Dynamic> start{law(options.seed, m).q, law(options.seed, m).p};
      const auto run = integrate(of_chain, by_verlet, step, start, options.steps);
      const double rise = energy<double>(of_chain, run.finish) - energy<double>(of_chain, start);
      const double of_one = run.diverged_at ? 0.0 : std::min(1.0, std::exp(-rise / 0.1));
      BOOST_TEST(all.of_each[m] == of_one);
      sum += of_one;
      if (!run.diverged_at) continue;
      BOOST_TEST(all.diverged_at.at(lost).trajectory == static_cast<std::int64_t>(m));
      BOOST_TEST(all.diverged_at.at(lost++).step == *run.diverged_at);
    }
    BOOST_TEST(all.diverged_at.size() == lost);
    BOOST_TEST((lost > 0U) == (step == 0.05));
    BOOST_TEST(lost < 37U);
    BOOST_TEST(all.probability.mean == sum / 37.0, tolerance(1e-14));  // 37 roundings
    BOOST_TEST(all.probability.standard_error == mean_and_error(all.of_each).standard_error);
    BOOST_TEST((all.probability.mean > 0.1 || lost > 0U));
    BOOST_TEST(all.probability.mean < 0.99);
    BOOST_TEST(all.evaluations_per_time == double(options.steps + 1) / (double(options.steps) * step),
               tolerance(1e-14));
  }
}

// With an odd K a palindrome runs back from (q, p) by -h, and not from (q, -p).
BOOST_AUTO_TEST_CASE(what_is_no_proposal_is_refused) {
  const trajectory_options options{.step = 0.01, .steps = 5, .trajectories = 3};
  const method one_way = start_of<aba3_free>();
  BOOST_TEST(refuses([&] { acceptance(chain, one_way, law, options); },
                     {"aba3_free", "must be reversible", "symmetric"}));
  const model warm = of_chain.in(bath::of_temperature(1.0, 1.0));
  BOOST_TEST(refuses([&] { acceptance(warm, by_verlet, initial_states(law), options); }, {"bath"}));
  const model at_rest = of_chain.in(bath::of_sigma(0.0, 0.0));
  BOOST_TEST(acceptance(at_rest, by_verlet, initial_states(law), options).of_each.size() == 3U);
  for (const double temperature : {0.0, -1.0, infinite, std::nan("")}) {
    BOOST_TEST(refuses([&] { acceptance(chain, by_verlet, law, options, temperature); }, {"kT", "positive"}));
  }
  BOOST_TEST(refuses([&] { acceptance(chain, by_verlet, law, {.step = 0.01, .steps = 0}); },
                     {"0 steps", "at least 1"}));

  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 1.0, 1.0);
  const auto with = [&](double tilt, double bend) {
    return acceptance(tilted{tilt, bend}, by_verlet, starts, options).of_each.size();
  };
  BOOST_TEST(with(0.0, 0.0) == 3U);
  for (const auto& odd : {std::pair(1e-3, 0.0), std::pair(0.0, 1e-3), std::pair(-1.0, 0.3)}) {
    BOOST_TEST(refuses([&] { with(odd.first, odd.second); }, {"kinetic energy", "even", "initial state 0"}));
  }
}

// Long trajectories have the mean of sin^2, 1/2 but for its end: one part in the phase, 2 pi 100. The second
// moment has mu + mu^2/2 for mu, 2 % at the largest mu here, 0.04, beside what the sample allows.
BOOST_AUTO_TEST_CASE(of_a_gaussian_target_many_times_larger_the_step_is_that_of_its_spectrum) {
  constexpr double larger = 500.0;
  const proposal_options options{.length = 100.0, .times_larger = larger, .states = 400, .seed = seed(1)};
  const double of_part = detail::acceptance_at(energy_error_at(0.9) / larger);
  for (const auto& method : {by_verlet, nysalt::method(bcss3{})}) {
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
               tolerance(1e-12));
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
  const auto here =
      detail::acceptance_of_proposals(system_of_all, by_verlet, found.step, thermal(0.5), options);
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
      system_of_all, [](double step) { return method(s_aia3(1.5 * step)); }, 0.5, 1.0, thermal(), options);
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

BOOST_AUTO_TEST_CASE(targets_and_proposals_that_cannot_be_are_refused) {
  const std::vector<double> one{1.0};
  const std::vector<double> none{0.0};
  const std::vector<double> many(1000, 1.0);
  BOOST_TEST(refuses([&] { gaussian_step(by_verlet, none, 0.9); }, {"a frequency must be positive"}));
  BOOST_TEST(refuses([&] { gaussian_step(by_verlet, {}, 0.9); }, {"a frequency must be positive"}));
  for (const double acceptance : {0.0, 1.0, -1.0, std::nan("")}) {
    BOOST_TEST(refuses([&] { gaussian_step(by_verlet, one, acceptance); }, {"between 0 and 1"}));
  }
  BOOST_TEST(
      refuses([&] { gaussian_step(by_verlet, many, 1.0 - 1e-12); }, {"must be one that verlet reaches"}));
  BOOST_TEST(refuses([&] { gaussian_step(method(mclachlan_atela4{}), one, 0.9); }, {"must be reversible"}));

  const auto at = [&](proposal_options options, double step = 0.1) {
    return detail::acceptance_of_proposals(system_of_all, by_verlet, step, thermal(), options);
  };
  BOOST_TEST(refuses([&] { at({.length = 0.0}); }, {"length must be positive"}));
  BOOST_TEST(refuses([&] { at({.length = 1.0, .times_larger = -1.0}); }, {"times_larger"}));
  BOOST_TEST(refuses([&] { at({.length = 1.0}, 1e-9); }, {"at most 1", "take a larger step"}));
  BOOST_TEST(refuses([&] { at({.length = 1.0}, -0.1); }, {"step must be positive"}));
  const method one_way("one way", word("AB"), {1.0, 1.0}, {1, false, false});
  BOOST_TEST(refuses([&] { step_of(one_way, 0.9, 0.1, {.length = 1.0}); }, {"must be reversible"}));
  for (const double acceptance : {0.0, 1.0}) {
    BOOST_TEST(refuses([&] { step_of(by_verlet, acceptance, 0.1, {.length = 1.0}); }, {"between 0 and 1"}));
  }
  // No word of wrong order keeps the energy of a part of 1e30.
  BOOST_TEST(refuses<std::runtime_error>(
      [&] { step_of(by_verlet, 0.9, 1.0, {.length = 5.0, .times_larger = 1e30, .states = 8}); },
      {"must be one that a step down to"}));
}
