// SPDX-License-Identifier: BSL-1.0
// An ensemble as a value: what the library's compiled half starts trajectories from.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/ensemble.hpp"

namespace nysalt {

/// Any ensemble behind one type; one converts to it. Copies share the ensemble. Its states have a dimension
/// that is known at run time.
class initial_states {
 public:
  using state = phase_point<double, Eigen::Dynamic>;  ///< state of one trajectory

  /// The initial states of an ensemble(seed, n) with a description(), which is copied.
  template <class E>
    requires(!std::same_as<E, initial_states>) && requires(const E& e) {
      e(std::uint64_t{}, std::uint64_t{}).q;
      { e.description() } -> std::convertible_to<std::string>;
    }
  initial_states(const E& ensemble)  // NOLINT(google-explicit-constructor)
      : text_(ensemble.description()) {
    at_ = [ensemble](std::uint64_t seed, std::uint64_t n) -> state {
      const auto x = ensemble(seed, n);
      return {x.q, x.p};
    };
    if constexpr (requires { ensemble.size(); }) size_ = static_cast<std::int64_t>(ensemble.size());
    if constexpr (requires { ensemble.is_expensive(); }) is_expensive_ = ensemble.is_expensive();
    using T = detail::scalar_of_lanes<detail::default_lanes>;
    if constexpr (requires { ensemble.template block<T>(std::uint64_t{}, std::int64_t{}, int{}); }) {
      is_expensive_ = true;
      several_ = [ensemble](std::uint64_t seed, std::int64_t first, int count) {
        std::vector<state> result;
        const auto all = ensemble.template block<T>(seed, first, count);
        for (int k = 0; k < count; ++k) {
          const auto x = lane(all, k);
          result.push_back({x.q, x.p});
        }
        return result;
      };
    }
  }

  /// The start of trajectory n.
  state operator()(std::uint64_t seed, std::uint64_t n) const { return at_(seed, n); }
  /// Initial states of `count` trajectories from the first on, one in each lane of T; lanes beyond them
  /// repeat the first. At most default_lanes.
  template <class T>
  phase_point<T, Eigen::Dynamic> block(std::uint64_t seed, std::int64_t first, int count) const {
    if (several_) {
      const auto all = several_(seed, first, std::min(count, lanes_in<T>));
      return detail::gather<T, Eigen::Dynamic>(count,
                                               [&](int k) { return all[static_cast<std::size_t>(k)]; });
    }
    return detail::gather<T, Eigen::Dynamic>(
        count, [&](int k) { return at_(seed, static_cast<std::uint64_t>(first + k)); });
  }
  bool makes_blocks() const { return several_ != nullptr; }  ///< several at a time cost less
  const std::string& description() const { return text_; }   ///< description of the ensemble
  bool is_expensive() const { return is_expensive_; }  ///< whether a state takes a simulation of its own
  std::int64_t size() const { return size_; }          ///< number of states

 private:
  std::function<state(std::uint64_t, std::uint64_t)> at_;
  std::function<std::vector<state>(std::uint64_t, std::int64_t, int)> several_;
  std::string text_;
  bool is_expensive_ = false;
  std::int64_t size_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace nysalt
