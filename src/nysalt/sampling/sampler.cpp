// SPDX-License-Identifier: BSL-1.0

#include "sampler.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/hmc.hpp"

namespace nysalt::detail {

void require_metropolis_applies(const char* who, const model& system, const method& method,
                                double temperature) {
  if (!method.symmetric) {
    throw std::invalid_argument(
        sentence("{}: the method must be reversible, or Hybrid Monte Carlo samples another distribution, got "
                 "{}; take a symmetric method",
                 who, method.name()));
  }
  if (system.bath().acts()) {
    throw std::invalid_argument(
        sentence("{}: H must be conserved, got {}; take the system without its bath", who, describe(system)));
  }
  if (!(temperature > 0.0) || !std::isfinite(temperature)) {
    throw std::invalid_argument(sentence("{}: kT must be positive and finite, got {}", who, temperature));
  }
}

energy_rises rises_of_energy(const model& system, const method& method, double step,
                             const initial_states& starts, const ensemble_options& options) {
  const auto samples = static_cast<std::size_t>(options.steps / options.every);
  std::vector<double> at_start(static_cast<std::size_t>(options.trajectories));
  std::vector<double> rises(at_start.size() * samples, std::numeric_limits<double>::infinity());
  const auto read = [&]<class T>(const phase_point<T, Eigen::Dynamic>& x, std::span<T> number) {
    number[0] = energy<T>(system, x);
  };
  const auto take = [&](std::int64_t m, std::int64_t n, std::span<const double> energy) {
    const auto row = static_cast<std::size_t>(m);
    if (n == 0) at_start[row] = energy[0];
    const double rise = energy[0] - at_start[row];
    if (n > 0 && std::isfinite(rise))
      rises[row * samples + static_cast<std::size_t>(n / options.every) - 1] = rise;
  };
  const auto stepper = make_stepper(system, method, step);
  return with_scalar_of(system, [&]<class T>(T) -> energy_rises {
    auto diverged_at = integrate_ensemble<T>(stepper, starts, options, 1, read, take);
    return {std::move(rises), std::move(diverged_at)};
  });
}

Eigen::VectorXd deviations_of(const std::vector<moments>& of_chains, const shard& mine, std::int64_t chains,
                              Eigen::Index size) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
  const auto count = static_cast<double>(chains);
  std::vector<Eigen::VectorXd> means;
  for (const auto& one : of_chains) means.push_back(one.mean);
  const Eigen::VectorXd mean = mine.sum(means, zero) / count;
  std::vector<Eigen::VectorXd> squares;
  for (const auto& one : of_chains)
    squares.push_back(one.squares / one.count + (one.mean - mean).cwiseAbs2());
  const Eigen::VectorXd variance = mine.sum(squares, zero) / count;
  Eigen::Index still = 0;
  if (!(variance.minCoeff(&still) > 0.0)) {
    throw std::runtime_error(
        sentence("hmc: coordinate {} must vary in the burn-in to have a mass of its own; take a smaller "
                 "step, a longer burn-in, or no diagonal_masses",
                 still + 1));
  }
  return variance.cwiseSqrt();
}

}  // namespace nysalt::detail

// Convergence of several chains, estimated from their draws.

namespace nysalt {

namespace {

double mean_of(std::span<const double> x) {
  double sum = 0.0;
  for (const double y : x) sum += y;
  return sum / static_cast<double>(x.size());
}

/// With n - 1.
double variance_of(std::span<const double> x) {
  const double mean = mean_of(x);
  double sum = 0.0;
  for (const double y : x) sum += (y - mean) * (y - mean);
  return sum / static_cast<double>(x.size() - 1);
}

std::size_t length_of(const std::vector<std::vector<double>>& chains) {
  for (const auto& chain : chains) {
    if (chain.size() == chains.front().size()) continue;
    throw std::invalid_argument(
        sentence("chains must be of one length, got {} and {} draws", chains.front().size(), chain.size()));
  }
  return chains.empty() ? 0 : chains.front().size();
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double potential_scale_reduction(const std::vector<std::vector<double>>& chains) {
  const std::size_t half = length_of(chains) / 2;
  if (half < 2) return nan;
  std::vector<double> means;
  std::vector<double> variances;
  for (const auto& chain : chains) {
    for (const std::span<const double> part : {std::span(chain).first(half), std::span(chain).last(half)}) {
      means.push_back(mean_of(part));
      variances.push_back(variance_of(part));
    }
  }
  const double within = mean_of(variances);
  if (!(within > 0.0)) return nan;
  const double n = static_cast<double>(half);
  return std::sqrt((n - 1.0) / n + variance_of(means) / within);
}

double effective_draws(const std::vector<std::vector<double>>& chains) {
  const std::size_t draws = length_of(chains);
  constexpr std::size_t least = 20;
  if (draws < least) return nan;
  const int lags = static_cast<int>(std::min<std::size_t>(draws / 3, 2000));
  double centre = 0.0;
  for (const auto& chain : chains) centre += mean_of(chain) / static_cast<double>(chains.size());
  std::vector<detail::autocovariance_sums> groups;
  for (const auto& chain : chains) {
    detail::autocovariance_along<double> sums(lags, centre);
    for (const double x : chain) sums.add(x);
    groups.push_back(sums.in_lane(0));
  }
  const autocovariance found(1.0, centre, std::move(groups));
  if (!(found.covariance(0) > 0.0)) return nan;
  return effective_sample_size(static_cast<double>(draws * chains.size()),
                               integrated_autocorrelation_time(found.normalised()));
}

}  // namespace nysalt
