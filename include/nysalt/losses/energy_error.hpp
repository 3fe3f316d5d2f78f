// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "nysalt/energy.hpp"
#include "nysalt/losses/stretch_error.hpp"

namespace nysalt {

/// r = (H after K steps - H at the start)/the root mean square of K(p) at the starts of all pairs. Refers to
/// the system. Throws std::invalid_argument if its energy is not known.
template <SeparableSystem S, Scalar R = scalar_of_passes<S>>
stretch_error<S, R> energy_error(const S& system, const flow_map_data<S::dimension>& data) {
  using C = typename stretch_error<S, R>::scalar;
  if constexpr (HasEnergy<S, C> && HasEnergy<S>) {
    std::vector<double> squares(data.trajectories(), 0.0);
    for (std::size_t m = 0; m < data.trajectories(); ++m) {
      for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
        const double k = kinetic_energy<double>(system, data.start[n].p);
        squares[m] += k * k;
      }
    }
    const double scale = 1.0 / std::sqrt(data.share().sum(squares) / static_cast<double>(data.all_pairs()));
    return {.residuals = 1,
            .of = [its = &system, scale](const auto& start, const auto& finish, const auto&, C* r) {
              const C before = energy<C>(*its, start.template cast<C>());
              r[0] = (energy<C>(*its, finish) - before) * scale;
            }};
  } else {
    throw std::invalid_argument(fmt::format(
        "an energy loss needs the potential of {} as a template over any scalar", describe(system)));
  }
}

}  // namespace nysalt
