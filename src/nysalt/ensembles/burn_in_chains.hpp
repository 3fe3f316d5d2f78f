// SPDX-License-Identifier: BSL-1.0
// Langevin chains of a temperature whose friction is ours to choose.
#pragma once

#include <cmath>
#include <cstdint>

#include "nysalt/detail/lockstep.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

/// BAOAB with noise of its own purpose: the numbers of (seed, chain, step) and no other run's. Momenta are
/// drawn from Maxwell's distribution p_i ~ N(0, m_i kT) where that is asked for.
class burn_in_chains {
 public:
  /// BAOAB on the system in the chains' bath.
  using stepper_type = stepper<model, run_time_word, double, counter_noise>;

  /// Chains of a system that comes without its bath; temperature is kT, an energy.
  burn_in_chains(const model& base, double temperature, double friction, double step, std::uint64_t seed)
      : system_(detail::own_copy(base).in(bath::of_temperature(friction, temperature))),
        stepper_(
            make_stepper(system_, tabulated(baoab{}), step, counter_noise(seed, noise_purpose::burn_in))) {}
  burn_in_chains(const burn_in_chains&) = delete;  // the stepper refers to the system
  burn_in_chains& operator=(const burn_in_chains&) = delete;

  const model& system() const { return system_; }                      ///< the system in the chains' bath
  double step() const { return stepper_.step_size(); }                 ///< h of BAOAB
  double temperature() const { return system_.bath().temperature(); }  ///< kT, an energy

  /// Chains under way in the lanes of T, from these positions; lane 0 sees the noise of chain `first`.
  template <class T>
  lockstep<stepper_type, T> open(phase_point<T, Eigen::Dynamic> start, std::int64_t first, int count) const {
    draw_momenta(start, first, 0);
    return {stepper_, start, count, first};
  }

  /// Draws momenta from Maxwell's distribution, with the noise of a step; lane 0 is chain `first`.
  template <class T>
  void draw_momenta(phase_point<T, Eigen::Dynamic>& x, std::int64_t first, std::int64_t step) const {
    constexpr int after_the_letter = 1;
    stepper_.noise().normals(noise_place{static_cast<std::uint64_t>(first), step, after_the_letter}, x.p);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      double square = temperature();
      if (!system_.has_unit_mass()) square /= system_.inverse_mass(i);
      x.p[i] = x.p[i] * std::sqrt(square);
    }
  }

 private:
  model system_;
  stepper_type stepper_;
};

}  // namespace nysalt
