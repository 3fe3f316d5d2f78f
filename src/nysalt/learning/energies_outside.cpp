// SPDX-License-Identifier: BSL-1.0
// A test whether starts are outside of the energies that were learned on, or outside by chance.
#include "nysalt/learning/energies_outside.hpp"

#include <fmt/format.h>

#include <algorithm>
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

double energies_outside::far() const {
  const double m = static_cast<double>(trajectories) + 1.0;
  if (trajectories < 2) return std::numeric_limits<double>::infinity();
  return (seen.high - seen.low) *
         std::max(0.0, std::log(static_cast<double>(examined) / (m * chance)) / std::log(m));
}

std::string energies_outside::report() const {
  return fmt::format(
      "{} of {} starts have energies outside {:.6g} to {:.6g}, on which it was learned (they go from "
      "{:.6g} "
      "to {:.6g})",
      outside, examined, seen.low, seen.high, energies.low, energies.high);
}

}  // namespace nysalt
