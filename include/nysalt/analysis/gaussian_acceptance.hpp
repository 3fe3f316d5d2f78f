// SPDX-License-Identifier: BSL-1.0
// Acceptance of Hybrid Monte Carlo where forces are linear, in closed form.
#pragma once

#include <span>

#include "nysalt/methods/tabulated.hpp"

namespace nysalt {

/// The acceptance of Metropolis' rule where the energy error of proposals, over kT, is normal with the mean
/// mu: erfc(sqrt(mu)/2), that is 2 Phi(-sqrt(mu/2)) [calvo_sanz_alonso_sanz_serna_2021]. As exp(-error) has
/// the mean 1 the variance is 2 mu. That is the limit of many dimensions; of one oscillator the distribution
/// is another.
double acceptance_at(double energy_error);

/// The mean energy error of an acceptance: the inverse of acceptance_at(). Throws std::invalid_argument
/// unless 0 < acceptance < 1.
double energy_error_at(double acceptance);

/// The mean of (H' - H)/kT over proposals of random duration on oscillators of these frequencies, from their
/// canonical distribution: half the sum of energy_error_on_oscillator() at h omega, as sin^2 is 1/2 on
/// average. It is exact as trajectories become long. Infinite where the method is not stable on one of them.
/// Throws std::invalid_argument if the method is not symmetric, and what energy_error_on_oscillator() throws.
/// Cost: that of energy_error_on_oscillator() for each frequency.
double gaussian_energy_error(const tabulated& method, std::span<const double> frequencies, double step);

/// The step up to which proposals are accepted with this probability: from `from` it grows by 2 % at a time
/// until the acceptance falls below it, or shrinks until it does not, and what lies between is halved. Where
/// none is given, `from` is a hundredth of a radian of the fastest oscillator. Words that are learned for a
/// step may be accepted less often at smaller ones: begin at theirs. Throws what gaussian_energy_error()
/// throws, and std::invalid_argument if no frequency is positive, or no step down to that hundredth is
/// accepted so often. Cost: some hundred times that of gaussian_energy_error().
double gaussian_step(const tabulated& method, std::span<const double> frequencies, double acceptance,
                     double from = 0.0);

}  // namespace nysalt
