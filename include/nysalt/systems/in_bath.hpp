// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/bath.hpp"
#include "nysalt/core/sentence.hpp"

namespace nysalt {

namespace detail {
/// The frequency bands of the system, at the temperature of the bath if the system has
/// frequency_bands_at(temperature).
template <HasFrequencyBands S>
std::vector<frequency_band> frequency_bands_in(const S& system, const bath& in) {
  if constexpr (requires { system.frequency_bands_at(1.0); }) {
    if (in.acts() && in.has_temperature()) return system.frequency_bands_at(in.temperature());
  }
  return system.frequency_bands();
}
}  // namespace detail

/// A Hamiltonian system in a bath: a Langevin system, dq = M^{-1} p dt,
/// dp = force(q) dt - gamma p dt + sigma M^{1/2} dW. All else is the system's own.
template <NystromSystem S>
  requires(!std::is_final_v<S> && !HasBath<S>)
class in_bath : public S {
 public:
  /// The bath may be one that does not act.
  in_bath(S system, const nysalt::bath& heat_bath) : S(std::move(system)), bath_(heat_bath) {}

  const nysalt::bath& bath() const { return bath_; }
  const S& base() const { return *this; }  ///< system without the bath

  /// Frequency bands of the system in this bath.
  std::vector<frequency_band> frequency_bands() const
    requires HasFrequencyBands<S>
  {
    return detail::frequency_bands_in(base(), bath_);
  }

  /// The system, and the bath that it is in; one that does not act goes without saying.
  std::string description() const {
    if (!bath_.acts()) return describe(base());
    return sentence("{} in {}", describe(base()), bath_.description());
  }
  /// Kind of the system, and the bath.
  std::string kind() const {
    if (!bath_.acts()) return detail::kind_of(base());
    return sentence("{} in {}", detail::kind_of(base()), bath_.description());
  }

 private:
  nysalt::bath bath_;
};

namespace detail {
template <class S>
struct written_system<in_bath<S>> : written_system<S> {};
}  // namespace detail

}  // namespace nysalt
