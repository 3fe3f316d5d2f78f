// SPDX-License-Identifier: BSL-1.0
// A system whose potential is a sum of parts, each with a force of its own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/systems/requirements.hpp"

namespace nysalt {

/// H = K + V_0 + V_1 + ...: each part is a system itself, of the same dimension, with a force or a potential
/// V_i; K is the kinetic energy of the first. So every word of K and V steps it, and the letters kick_of_part
/// and kick_of_parts, see flows/exact_flow.hpp, kick with the force of one part. Its forces are templates
/// over the scalar, no black boxes.
template <System First, System... Rest>
  requires((Rest::dimension == First::dimension) && ...)
class sum_of_parts {
 public:
  static constexpr int dimension = First::dimension;
  static constexpr std::size_t parts = 1 + sizeof...(Rest);  ///< number of parts
  /// Kicks with the force of one part, and with all of them.
  using letters = typename detail::kicks_of<std::make_index_sequence<parts>>::type;
  /// Most trajectories side by side: as many as each part bears.
  static constexpr int lanes = std::min({detail::lanes_of<First>, detail::lanes_of<Rest>...});

  /// Throws std::invalid_argument unless all parts have one size.
  explicit sum_of_parts(const First& first, const Rest&... rest) : parts_(first, rest...) {
    (detail::require_used_members<typename detail::written_system<Rest>::type>(), ...);
    (detail::require_no_near_members<typename detail::written_system<Rest>::type>(), ...);
    [[maybe_unused]] const auto require_same = [&](const auto& other) {
      if (nysalt::size(other) == nysalt::size(first)) return;
      throw std::invalid_argument(
          sentence("sum_of_parts: all parts must have the size {} of the first, got {}",
                   static_cast<long>(nysalt::size(first)), static_cast<long>(nysalt::size(other))));
    };
    (require_same(rest), ...);
  }

  /// Part I, from 0 on.
  template <std::size_t I>
  const auto& part() const {
    return std::get<I>(parts_);
  }
  Eigen::Index size() const { return nysalt::size(part<0>()); }  ///< degrees of freedom

  template <class T>
  T potential(const vector<T, dimension>& q) const
    requires(HasPotential<First, T> && (HasPotential<Rest, T> && ...))
  {
    return std::apply([&](const auto&... one) { return (one.potential(q) + ...); }, parts_);
  }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    nysalt::force<T>(part<0>(), q, f);
    if constexpr (parts > 1) {
      auto of_part = detail::make_vector<T>(part<0>());
      const auto add = [&](const auto& one) {
        nysalt::force<T>(one, q, of_part);
        for (Eigen::Index i = 0; i < f.size(); ++i) f[i] += of_part[i];
      };
      [&]<std::size_t... I>(std::index_sequence<I...>) {
        (add(part<I + 1>()), ...);
      }(std::make_index_sequence<parts - 1>());
    }
  }
  double inverse_mass(Eigen::Index i) const
    requires HasInverseMass<First>
  {
    return part<0>().inverse_mass(i);
  }
  std::string description() const {
    std::string all;
    std::apply([&](const auto&... one) { ((all += (all.empty() ? "" : " + ") + describe(one)), ...); },
               parts_);
    return all;
  }

 private:
  std::tuple<First, Rest...> parts_;
};

namespace detail {
template <class First, class... Rest>
First first_part_of(const sum_of_parts<First, Rest...>*);  // not defined
/// Of a sum of parts, and of what derives from one, which has members under constraints.
template <class S>
  requires requires(const S* sum) { first_part_of(sum); }
struct written_system<S> : written_system<decltype(first_part_of(static_cast<const S*>(nullptr)))> {};
}  // namespace detail

}  // namespace nysalt
