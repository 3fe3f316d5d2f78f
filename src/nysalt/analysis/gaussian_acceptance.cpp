// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/gaussian_acceptance.hpp"

#include <boost/math/special_functions/erf.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "nysalt/derivatives/energy_on_oscillator.hpp"
#include "nysalt/detail/sentence.hpp"

namespace nysalt {

double acceptance_at(double energy_error) {
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

double gaussian_energy_error(const tabulated& method, std::span<const double> frequencies, double step) {
  if (!method.symmetric) {
    throw std::invalid_argument(
        sentence("gaussian_energy_error: the method must be reversible, got {}; take a symmetric method",
                 method.name()));
  }
  const auto coefficients = method.coefficients();
  double sum = 0.0;
  for (const double omega : frequencies) {
    sum += 0.5 * energy_error_on_oscillator(method.letters(), coefficients, step * omega);
    if (!std::isfinite(sum)) return std::numeric_limits<double>::infinity();
  }
  return sum;
}

double gaussian_step(const tabulated& method, std::span<const double> frequencies, double acceptance,
                     double from) {
  const double most = energy_error_at(acceptance);
  const double fastest = frequencies.empty() ? 0.0 : *std::ranges::max_element(frequencies);
  if (!(fastest > 0.0)) {
    throw std::invalid_argument("gaussian_step: a frequency must be positive, got none");
  }
  const auto holds = [&](double step) { return gaussian_energy_error(method, frequencies, step) <= most; };
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
