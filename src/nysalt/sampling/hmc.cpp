// SPDX-License-Identifier: BSL-1.0
#include "nysalt/hmc.hpp"

#include <cmath>
#include <stdexcept>

#include "nysalt/core/sentence.hpp"
#include "sampler.hpp"

namespace nysalt {

namespace {

void require_options(const model& system, const hmc_options& options) {
  const auto positive = [](const char* name, double value) {
    if (value > 0.0 && std::isfinite(value)) return;
    throw std::invalid_argument(sentence("hmc: {} must be positive and finite, got {}", name, value));
  };
  positive("step", options.step);
  positive("length", options.length);
  constexpr double most_steps = 1e6;
  if (options.length > most_steps * options.step) {
    throw std::invalid_argument(
        sentence("hmc: length must be at most {} steps, got {} with steps of {}; take a larger step",
                 most_steps, options.length, options.step));
  }
  const auto at_least = [](const char* name, std::int64_t value, std::int64_t least) {
    if (value >= least) return;
    throw std::invalid_argument(sentence("hmc: {} must be at least {}, got {}", name, least, value));
  };
  at_least("chains", options.chains, 1);
  at_least("draws", options.draws, 1);
  at_least("burn_in", options.burn_in, options.acceptance || options.diagonal_masses ? 100 : 0);
  constexpr std::int64_t most = detail::numbers_with_own_noise;
  const auto of_chain = static_cast<double>(options.burn_in) + static_cast<double>(options.draws);
  if (static_cast<double>(options.chains) * of_chain > static_cast<double>(most)) {
    throw std::invalid_argument(
        sentence("hmc: chains times burn_in and draws must be at most 2^48 = {}, got {} times {} and {}",
                 most, options.chains, options.burn_in, options.draws));
  }
  at_least("threads", options.execution.threads, 1);
  at_least("keep_every", options.keep_every, 0);
  if (options.diagonal_masses && !options.acceptance) {
    throw std::invalid_argument(
        "hmc: diagonal_masses must come with an acceptance, as they change the unit of time, and with it the "
        "step; ask for an acceptance, to which the step is tuned");
  }
  if (options.acceptance && !(*options.acceptance > 0.0 && *options.acceptance < 1.0)) {
    throw std::invalid_argument(
        sentence("hmc: acceptance must be between 0 and 1, got {}", *options.acceptance));
  }
  if (!has_quadratic_kinetic(system)) {
    throw std::invalid_argument(sentence(
        "hmc: the kinetic energy of {} must be quadratic in p, as momenta are normal", describe(system)));
  }
  if (!system.facts().has_potential) {
    throw std::invalid_argument(
        sentence("hmc: {} must have a potential, by which proposals are accepted; add potential(q)",
                 describe(system)));
  }
}

/// Large systems are stepped one chain after the other, as loops over coordinates fill the lanes then.
bool has_room_for_lanes(const model& system) {
  constexpr Eigen::Index most = 512;
  return system.facts().in_lanes && size(system) <= most;
}

}  // namespace

hmc_result hmc(const model& system, const method& method, const initial_states& starts,
               const hmc_options& options, const std::function<void(const hmc_draw&)>& take) {
  detail::require_metropolis_applies("hmc", system, method, options.temperature);
  require_options(system, options);
  if (options.diagonal_masses && method.letters().has_own_letters()) {
    throw std::invalid_argument(
        sentence("hmc: the word must have no letters of one's own for diagonal_masses, which make another "
                 "system, got {}; leave diagonal_masses away",
                 method.letters().letters()));
  }
  if (has_room_for_lanes(system)) {
    return detail::sampler<detail::lanes>(system, method, starts, options).run(take);
  }
  return detail::sampler<double>(system, method, starts, options).run(take);
}

}  // namespace nysalt
