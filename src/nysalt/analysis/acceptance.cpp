// SPDX-License-Identifier: BSL-1.0

#include "nysalt/analysis/acceptance.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>

#include "../sampling/sampler.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/shard.hpp"

namespace nysalt {

namespace {

/// K(-p) = K(p) and grad K(-p) = -grad K(p), at the momenta of start number m.
void require_even_kinetic(const model& system, const Eigen::VectorXd& p, std::int64_t m) {
  const Eigen::VectorXd back = -p;
  Eigen::VectorXd v(p.size());
  Eigen::VectorXd v_back(p.size());
  velocity<double>(system, p, v);
  velocity<double>(system, back, v_back);
  // An even formula has the same terms at -p: it differs by the rounding of sums, 100 operations of eps, of
  // terms that cancel to a part of 7e5.
  const double rounding = std::sqrt(std::numeric_limits<double>::epsilon());
  const double odd = (v + v_back).cwiseAbs().maxCoeff();
  const double largest = v.cwiseAbs().maxCoeff();
  bool is_even = odd <= rounding * largest;
  if (system.facts().has_own_kinetic_energy) {
    const double k = kinetic_energy<double>(system, p);
    is_even = is_even && std::abs(k - kinetic_energy<double>(system, back)) <= rounding * std::abs(k);
  }
  if (is_even) return;
  throw std::invalid_argument(
      sentence("acceptance: the kinetic energy must be even, K(-p) = K(p), got another at initial state {}; "
               "take a K that is even, or Hybrid Monte Carlo samples another distribution",
               m));
}

}  // namespace

acceptance_result acceptance(const model& system, const method& method, const initial_states& ensemble,
                             const trajectory_options& options, double temperature) {
  detail::require_metropolis_applies("acceptance", system, method, temperature);
  if (!has_energy(system)) {
    throw std::invalid_argument(sentence(
        "acceptance: H must be known, got {} without a potential; give the system one", describe(system)));
  }
  collectively(*options.execution.ranks, [&] { detail::require_room(options, 1, 1); });
  if (!has_quadratic_kinetic(system)) {
    constexpr std::int64_t enough = 16;
    for (std::int64_t m = 0; m < std::min(enough, options.trajectories); ++m) {
      require_even_kinetic(system, sound_start(system, ensemble, options.seed, m).p, m);
    }
  }
  auto [of_each, diverged] = detail::rises_of_energy(system, method, options.step, ensemble,
                                                     {.trajectories = options.trajectories,
                                                      .steps = options.steps,
                                                      .every = options.steps,
                                                      .seed = options.seed,
                                                      .execution = options.execution});
  for (double& rise : of_each) rise = rise <= 0.0 ? 1.0 : std::exp(-rise / temperature);
  shard(options.trajectories, *options.execution.ranks).gather(of_each);

  acceptance_result result{mean_and_error(of_each), of_each, {}};
  for (std::size_t m = 0; m < diverged.size(); ++m) {
    if (diverged[m]) result.diverged_at.push_back({static_cast<std::int64_t>(m), *diverged[m]});
  }
  const auto evaluations =
      evaluations_of_run(system, method, options.step, options.steps, ensemble(options.seed, 0));
  const double time = static_cast<double>(options.steps) * std::abs(options.step);
  result.evaluations_per_time = static_cast<double>(evaluations) / time;
  return result;
}

double detail::acceptance_at(double energy_error) {
  return energy_error > 0.0 ? std::erfc(0.5 * std::sqrt(energy_error)) : 1.0;
}

double energy_error_at(double acceptance) {
  if (!(acceptance > 0.0 && acceptance < 1.0)) {
    throw std::invalid_argument(
        sentence("energy_error_at: the acceptance must be between 0 and 1, got {}", acceptance));
  }
  const double root = 2.0 * boost::math::erfc_inv(acceptance);
  return root * root;
}

double detail::gaussian_energy_error(const method& method, std::span<const double> frequencies, double step) {
  if (!method.symmetric) {
    throw std::invalid_argument(
        sentence("gaussian_energy_error: the method must be reversible, got {}; take a symmetric method",
                 method.name()));
  }
  const auto coefficients = method.coefficients();
  double sum = 0.0;
  for (const double omega : frequencies) {
    sum += 0.5 * detail::energy_error_on_oscillator(method.letters(), coefficients, step * omega);
    if (!std::isfinite(sum)) return std::numeric_limits<double>::infinity();
  }
  return sum;
}

double gaussian_step(const method& method, std::span<const double> frequencies, double acceptance,
                     double from) {
  const double most = energy_error_at(acceptance);
  const double fastest = frequencies.empty() ? 0.0 : *std::ranges::max_element(frequencies);
  if (!(fastest > 0.0)) {
    throw std::invalid_argument("gaussian_step: a frequency must be positive, got none");
  }
  const auto holds = [&](double step) {
    return detail::gaussian_energy_error(method, frequencies, step) <= most;
  };
  constexpr double growth = 1.02;
  const double least = 0.01 / fastest;
  double low = std::max(least, from);
  while (!holds(low)) {
    low /= growth;
    if (low >= least) continue;
    throw std::invalid_argument(
        sentence("gaussian_step: the acceptance must be one that {} reaches at a step down to {}, got {}; "
                 "ask for a lower acceptance",
                 method.name(), least, acceptance));
  }
  while (holds(growth * low)) low *= growth;
  double high = growth * low;
  constexpr double precision = 1e-9;
  while (high - low > precision * low) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace nysalt
