// SPDX-License-Identifier: BSL-1.0
#include "step_of_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/initial_states.hpp"

namespace nysalt {

namespace {

using states_in_double = std::vector<phase_point<double, Eigen::Dynamic>>;

/// The highest frequency at some states; 0 where nothing oscillates, or the force has no derivative.
double frequency_at(const model& system, const states_in_double& states) {
  if (!has_quadratic_kinetic(system)) return 0.0;
  try {
    return hessian_spectrum(system, states).highest_frequency();
  } catch (const std::invalid_argument&) {  // a force without a derivative
    return 0.0;
  }
}

/// The largest |f_i|/sqrt(m_i kT) at some states, an inverse time; 0 without forces.
double thermal_rate_at(const model& system, const states_in_double& states, double temperature) {
  auto f = detail::make_vector<double>(system);
  double largest = 0.0;
  for (const auto& state : states) {
    force<double>(system, state.q, f);
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      const double inverse_mass = system.has_unit_mass() ? 1.0 : system.inverse_mass(i);
      const double rate = std::abs(f[i]) * std::sqrt(inverse_mass / temperature);
      if (std::isfinite(rate)) largest = std::max(largest, rate);
    }
  }
  return largest;
}

}  // namespace

double step_of_motion(const model& system, const initial_states& from, double temperature, double z,
                      const std::string& who) {
  if (const double omega = highest_frequency(system.frequency_bands()); omega > 0.0) return z / omega;
  constexpr std::int64_t some = 8;
  states_in_double states;
  for (std::int64_t n = 0; n < std::min(some, from.size()); ++n) {
    states.push_back(sound_start(system, from, 1, n));
  }
  const double omega = frequency_at(system, states);
  const double rate = omega > 0.0 ? omega : thermal_rate_at(system, states, temperature);
  if (rate > 0.0) return z / rate;
  throw std::invalid_argument(sentence(
      "{}: the system must have frequencies or forces at its starts for a default step, got {}; give "
      "a step",
      who, describe(system)));
}

}  // namespace nysalt
