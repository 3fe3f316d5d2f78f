// SPDX-License-Identifier: BSL-1.0
// What any system with a law of starts can do for the commands.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "bundled_systems.hpp"
#include "nysalt/analysis/error_measures/exchange.hpp"
#include "nysalt/detail/any_reference.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/systems/in_bath.hpp"

namespace nysalt::program {

struct named_value {
  std::string name;
  std::variant<std::int64_t, double, std::string> value;
};

struct model_facts {
  std::vector<named_value> parameters;  // as scheme files hold them
  double frequency;                     // the highest, of rare starts
  std::string default_observable;
  double fine_angle = 5e-3;  // of a fine step, times the highest frequency: there srkn11b errs by rounding
};

template <class T>
using energy_of_spring = T(const phase_point<T, Eigen::Dynamic>& x, Eigen::Index j);

/// The energies of the stiff springs of a system that has some.
struct stiff_springs {
  Eigen::Index pairs = 0;                                   ///< 0: there are none
  nysalt::detail::over_scalars<energy_of_spring> energy{};  ///< of spring j, and of all if j < 0
};

template <class S>
stiff_springs stiff_springs_of(const S& system) {
  stiff_springs result;
  if constexpr (HasStiffEnergies<S>) {
    const auto energy = [system]<class T>(const phase_point<T, Eigen::Dynamic>& x, Eigen::Index j) -> T {
      const auto& own = nysalt::detail::of_dimension<S::dimension>(x);
      return j < 0 ? system.stiff_energy(own) : system.stiff_energy(own, j);
    };
    result = {system.pairs(), energy};
  }
  return result;
}

/// What is made of a system and a law by their types.
struct system_parts {
  model in_bath;
  initial_states law;
  stiff_springs springs;
  std::shared_ptr<const detail::any_reference> exact;  // the exact flow of the model, if it is known
  bool has_linear_force;
};

std::unique_ptr<bundled_system> make_bundled(const system_parts& parts, const surroundings& conditions,
                                             const model_facts& facts);

/// A system with its law of starts. Where its flow is known exactly, that is the reference unless a fine step
/// is asked for.
template <bool has_exact_flow = false, class S, class Law>
std::unique_ptr<bundled_system> make_bundled(const S& system, const surroundings& conditions, const Law& law,
                                             const model_facts& facts) {
  const in_bath<S> put(system, conditions.bath);
  system_parts parts{put, law, stiff_springs_of(system), nullptr, has_exact_flow};
  if constexpr (has_exact_flow) {
    if (!conditions.bath.acts()) parts.exact = detail::reference_of(put, exact_linear(put));
  }
  return make_bundled(parts, conditions, facts);
}

}  // namespace nysalt::program
