// SPDX-License-Identifier: BSL-1.0
#include "burn_in.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace nysalt {

void detail::require_burn_in(const burn_in_options& options) {
  const auto sound = [](const char* what, double value) {
    if (value >= 0.0 && std::isfinite(value)) return;
    throw std::invalid_argument(fmt::format(
        "gibbs: the {} of the burn-in must be finite and positive, or 0 to be found, got {}", what, value));
  };
  sound("friction", options.friction);
  sound("step", options.step);
  sound("length", options.length);
  if (options.pilots >= 16 && options.pilots <= 100'000 && options.most_steps >= 1) return;
  throw std::invalid_argument(
      fmt::format("gibbs: pilots must be 16 to 100000 and most_steps >= 1, got {} and {}", options.pilots,
                  options.most_steps));
}

void detail::refuse_escape(const watched_interval& later, const model& system) {
  const auto& virials = later.square[static_cast<std::size_t>(watched::virial)];
  if (std::ranges::all_of(virials, [](double one) { return one == 0.0; })) {
    throw std::runtime_error(fmt::format(
        "gibbs: the motion of {} must be confined, got chains that have all left and meet no force",
        describe(system)));
  }
  // Half-way between the 1/2 of a half-line and the 0 of what repeats itself.
  if (const double free = later.share_without_force(); free > 0.25) {
    throw std::runtime_error(fmt::format(
        "gibbs: the motion of {} must be confined, or its potential the same wherever it goes, got {:.0f} % "
        "of the chains that have left and meet no force along a coordinate",
        describe(system), 100.0 * free));
  }
  const discrepancy potential = later.potential_of_the_far();
  if (!potential.shows()) return;
  throw std::runtime_error(fmt::format(
      "gibbs: the motion of {} must be confined, or its potential the same wherever it goes, got chains that "
      "leave: the "
      "potential energy of the half that went farther is larger by {:.3g} +- {:.3g} kT for each coordinate",
      describe(system), potential.mean, potential.standard_error));
}

void detail::refuse_discrepancy(const discrepancy& found, std::size_t i, const char* what,
                                const burn_in_report& report) {
  if (!found.shows()) return;
  throw std::runtime_error(
      fmt::format("gibbs: after a burn-in of {:.6g} the {} must {}, got a difference of {:.3g} +- {:.3g} kT; "
                  "burn in for longer",
                  report.length, watched_names[i], what, found.mean, found.standard_error));
}

}  // namespace nysalt
