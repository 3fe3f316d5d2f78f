// SPDX-License-Identifier: BSL-1.0
// A test whether starts are outside of the energies that were learned on, or outside by chance.
#include "nysalt/learning/energies_outside.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace nysalt {

double energies_outside::probability() const {
  const auto m = static_cast<double>(trajectories);
  const auto n = static_cast<double>(examined);
  double term = m * (m - 1.0) / ((m + n) * (m + n - 1.0));  // that none is
  double rest = 1.0;
  for (std::size_t j = 0; j < outside; ++j) {
    rest -= term;
    const auto k = static_cast<double>(j);
    term *= (n - k) / (k + 1.0) * (k + 2.0) / (m + n - k - 2.0);
  }
  return rest;
}

// The largest of M exponential energies, the widest that are allowed for, is H with E exp(-t H) = Gamma(1 +
// t) M!/ Gamma(M + 1 + t): one of n others is beyond t H with n times that probability, or less.
double energies_outside::far() const {
  if (trajectories < 2) return std::numeric_limits<double>::infinity();
  const double m = static_cast<double>(trajectories) + 1.0;
  const double n = static_cast<double>(examined);
  const auto is_likely = [&](double t) {
    return std::log(n / chance) + std::lgamma(1.0 + t) + std::lgamma(m) - std::lgamma(m + t) > 0.0;
  };
  double near = 1.0;
  double beyond = 1.0;
  while (is_likely(beyond)) beyond *= 2.0;
  for (int k = 0; k < 50; ++k) {  // to rounding
    const double middle = 0.5 * (near + beyond);
    (is_likely(middle) ? near : beyond) = middle;
  }
  return (seen.high - seen.low) * (beyond - 1.0);
}

std::string energies_outside::report() const {
  return fmt::format(
      "{} of {} starts have energies outside {:.6g} to {:.6g}, on which it was learned (they go from "
      "{:.6g} "
      "to {:.6g})",
      outside, examined, seen.low, seen.high, energies.low, energies.high);
}

}  // namespace nysalt
