// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/losses/window_error.hpp"

namespace nysalt {

namespace detail {
/// 1/the root mean square of K(p) at the starts of all pairs. Throws std::invalid_argument if the energy of
/// the system is not known.
double scale_of_energies(const model& system, const flow_map_data& data);
}  // namespace detail

/// r = (H after K steps - H at the start)/the root mean square of K(p) at the starts of all pairs. Throws
/// std::invalid_argument if the system's energy is not known.
template <Scalar R = detail::lanes>
window_error<R> energy_error(const model& system, const flow_map_data& data) {
  using C = typename window_error<R>::scalar;
  const double scale = detail::scale_of_energies(system, data);
  return {.residuals = 1, .of = [system, scale](const auto& start, const auto& finish, const auto&, C* r) {
            const C before = energy<C>(system, start.template cast<C>());
            r[0] = (energy<C>(system, finish) - before) * scale;
          }};
}

}  // namespace nysalt
