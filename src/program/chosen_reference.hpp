// SPDX-License-Identifier: BSL-1.0
// A reference that is chosen at run time, so that what is built on one is compiled once for each system.
#pragma once

#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_paths.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/linear_chain.hpp"

namespace nysalt::program {

/// Systems whose flow is known exactly: it is the reference unless a fine step is asked for.
template <class S>
inline constexpr bool has_exact_flow =
    std::is_same_v<S, harmonic_oscillator> || std::is_same_v<S, linear_chain>;

/// A PathReference for the system S, in a bath or in none, where there is no noise to tell of.
template <class S>
class chosen_reference {
 public:
  using one_of = std::conditional_t<has_exact_flow<S>, std::variant<fine_steps<>, fine_paths<>, exact_linear>,
                                    std::variant<fine_steps<>, fine_paths<>>>;

  explicit chosen_reference(one_of which) : which_(std::move(which)) {}

  template <HasBath InBath, Scalar T>
  void advance(const InBath& system, phase_point<T, InBath::dimension>& x, double t, const path_place& at,
               std::span<vector<T, InBath::dimension>> xi) const {
    const auto go_on = [&](const auto& its) { advance_lanes(system, its, x, t, lanes_in<T>, at, xi); };
    std::visit(go_on, which_);
  }
  chosen_reference finer() const {
    return std::visit([](const auto& its) { return chosen_reference(its.finer()); }, which_);
  }
  std::string description() const {
    return std::visit([](const auto& its) { return its.description(); }, which_);
  }

 private:
  one_of which_;
};

}  // namespace nysalt::program
