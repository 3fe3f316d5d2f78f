// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/acceptance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>

#include "nysalt/core/sentence.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/shard.hpp"
#include "sampler.hpp"

namespace nysalt {

namespace {

void require_proposals(const model& system, const method& method, double step,
                       const proposal_options& options) {
  constexpr const char* who = "acceptance_of_proposals";
  detail::require_metropolis_applies(who, system, method, options.temperature);
  const auto positive = [&](const char* name, double value) {
    if (value > 0.0 && std::isfinite(value)) return;
    throw std::invalid_argument(sentence("{}: {} must be positive and finite, got {}", who, name, value));
  };
  positive("step", step);
  positive("length", options.length);
  positive("times_larger", options.times_larger);
  constexpr double most_steps = 1e5;
  if (2.0 * options.length / step > most_steps) {
    throw std::invalid_argument(sentence(
        "{}: a trajectory of duration {} must have at most {} steps, got steps of {}; take a larger step",
        who, 2.0 * options.length, most_steps, step));
  }
  if (!has_quadratic_kinetic(system) || !system.facts().has_potential) {
    throw std::invalid_argument(sentence(
        "{}: {} must have a potential and a kinetic energy that is quadratic in p", who, describe(system)));
  }
}

/// The shares of durations, uniform from 0 to 2 length, that make 1, 2, ... steps: the nearest number, and
/// one at least.
std::vector<double> shares_of_steps(double longest) {
  const auto most = std::max<std::int64_t>(1, std::llround(longest));
  std::vector<double> shares;
  double last = 0.0;
  for (std::int64_t n = 1; n <= most; ++n) {
    const double end = n == most ? longest : static_cast<double>(n) + 0.5;
    shares.push_back((end - last) / longest);
    last = end;
  }
  return shares;
}

/// d acceptance_at(mu)/d mu.
double slope_of_acceptance(double mu) {
  return -0.5 * std::exp(-0.25 * mu) / std::sqrt(std::numbers::pi * mu);
}

}  // namespace

detail::proposal_acceptance detail::acceptance_of_proposals(const model& system, const method& method,
                                                            double step, const initial_states& states,
                                                            const proposal_options& options) {
  require_proposals(system, method, step, options);
  const auto shares = shares_of_steps(2.0 * options.length / step);
  const std::size_t width = shares.size();
  auto errors = detail::rises_of_energy(system, method, step, states,
                                        {.trajectories = options.states,
                                         .steps = static_cast<std::int64_t>(width),
                                         .every = 1,
                                         .seed = options.seed,
                                         .execution = options.execution})
                    .of_each;
  for (double& rise : errors) rise /= options.temperature;
  const shard mine(options.states, *options.execution.ranks);
  const auto first = static_cast<std::size_t>(mine.first());
  const auto end = first + static_cast<std::size_t>(mine.count());
  std::vector<double> of_each(static_cast<std::size_t>(options.states), 0.0);
  if (options.times_larger == 1.0) {
    for (std::size_t m = first; m < end; ++m) {
      for (std::size_t n = 0; n < width; ++n) {
        of_each[m] += shares[n] * std::min(1.0, std::exp(-errors[m * width + n]));
      }
    }
  } else {
    // mu of each state, whose mean is that of all.
    const auto mu_of = [&](std::size_t m, std::size_t n) {
      const double error = errors[m * width + n];
      return 0.5 * options.times_larger * error * error;
    };
    std::vector<Eigen::VectorXd> terms;
    for (std::size_t m = first; m < end; ++m) {
      Eigen::VectorXd& of_state = terms.emplace_back(static_cast<Eigen::Index>(width));
      for (std::size_t n = 0; n < width; ++n) of_state[static_cast<Eigen::Index>(n)] = mu_of(m, n);
    }
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(width));
    const Eigen::VectorXd mean = mine.sum(terms, zero) / static_cast<double>(options.states);
    for (std::size_t n = 0; n < width; ++n) {
      const double mu = mean[static_cast<Eigen::Index>(n)];
      if (!std::isfinite(mu)) continue;  // all are rejected
      const double slope = mu > 0.0 ? slope_of_acceptance(mu) : 0.0;
      for (std::size_t m = first; m < end; ++m) {
        of_each[m] += shares[n] * (detail::acceptance_at(mu) + slope * (mu_of(m, n) - mu));
      }
    }
  }
  mine.gather(of_each);
  return {mean_and_error(of_each), of_each};
}

acceptance_step step_at_acceptance(const model& system, const std::function<method(double step)>& method_at,
                                   double acceptance, double guess, const initial_states& states,
                                   const proposal_options& options) {
  if (!(acceptance > 0.0 && acceptance < 1.0)) {
    throw std::invalid_argument(
        sentence("step_at_acceptance: the acceptance must be between 0 and 1, got {}", acceptance));
  }
  const auto accepted = [&](double step) -> detail::proposal_acceptance {
    std::optional<method> method;
    try {
      method = method_at(step);
    } catch (const std::invalid_argument&) {
      return {{0.0, 0.0}, std::vector<double>(static_cast<std::size_t>(options.states), 0.0)};
    }
    return detail::acceptance_of_proposals(system, *method, step, states, options);
  };
  constexpr double growth = 8.0 / 7.0;
  constexpr double least = 1e-3;
  double low = std::min(guess, options.length);
  auto at_low = accepted(low);
  while (at_low.probability.mean < acceptance) {
    low /= growth;
    if (low < least * guess) {
      throw std::runtime_error(
          sentence("step_at_acceptance: the acceptance must be one that a step down to {} reaches, got {}; "
                   "ask for a lower acceptance",
                   low, acceptance));
    }
    at_low = accepted(low);
  }
  double high = low;
  auto at_high = at_low;
  while (at_high.probability.mean >= acceptance) {
    low = high;
    at_low = at_high;
    if (low >= options.length) {
      return {low, {std::log(low), 0.0}, std::vector<double>(at_low.of_each.size(), std::log(low)), true};
    }
    high = std::min(growth * low, options.length);
    at_high = accepted(high);
  }
  // The logarithm of the mean energy error is nearly linear in that of the step: a regula falsi between
  // brackets, which meets the acceptance to a tenth of a standard error of most samples.
  constexpr double precision = 1e-3;
  constexpr int most_refinements = 20;
  const auto level = [&](const detail::proposal_acceptance& at) {
    const double inside = std::clamp(at.probability.mean, 1e-12, 1.0 - 1e-12);
    return std::log(energy_error_at(inside) / energy_error_at(acceptance));
  };
  double step = low;
  detail::proposal_acceptance at = at_low;
  double slope = 0.0;  // of the acceptance, by log step
  for (int n = 0; n < most_refinements; ++n) {
    const double below = level(at_low);
    const double above = level(at_high);
    slope = (at_high.probability.mean - at_low.probability.mean) / std::log(high / low);
    const double part = std::clamp(below / (below - above), 0.05, 0.95);
    step = low * std::pow(high / low, part);
    at = accepted(step);
    if (std::abs(at.probability.mean - acceptance) <= precision || high / low < 1.0 + precision) break;
    (at.probability.mean >= acceptance ? low : high) = step;
    (at.probability.mean >= acceptance ? at_low : at_high) = at;
  }
  acceptance_step result{step, {}, {}};
  const double root = std::log(step) + (acceptance - at.probability.mean) / slope;
  result.step = std::exp(root);
  for (const double one : at.of_each) {
    result.log_of_each.push_back(root + (at.probability.mean - one) / slope);
  }
  result.log_step = mean_and_error(result.log_of_each);
  return result;
}

}  // namespace nysalt
