// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// Length of the trajectory, and the number of states kept.
struct long_trajectory_options {
  double length = 25'000.0;            ///< a time, burn-in included
  double burn_in = 0.0;                ///< a time at its beginning, of which no state is kept
  double step = 0.0;                   ///< h of BAOAB; 0: omega h = 0.1 at the highest frequency
  std::int64_t most_states = 100'000;  ///< largest number of states kept, evenly thinned; at most 100000
  std::uint64_t seed = 1;              ///< seed of the start and the noise
};

namespace detail {

/// The states of one_long_trajectory.
class long_trajectory {
 public:
  long_trajectory(const model& in_bath, const initial_states& from, const long_trajectory_options& options);

  std::size_t states() const { return states_.size(); }
  const phase_point<double, Eigen::Dynamic>& operator()(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const;

 private:
  long_trajectory_options options_;
  std::string from_;
  double step_ = 0.0;
  std::vector<phase_point<double, Eigen::Dynamic>> states_;
};

}  // namespace detail

/// States picked at random, with repetition, from one trajectory of a system in its bath, by BAOAB from start
/// 0 of another ensemble [li_lu_tao_ye_2023]. They depend on each other as far as the trajectory remembers:
/// of friction gamma it holds no more than about gamma T/2 independent ones, and without a burn-in its way
/// down from the start stays among them; independent states of the invariant distribution are gibbs. On-step
/// momenta are those of BAOAB, whose variance is low by (omega h)^2/4. Memory: the states that are kept.
template <int N>
class one_long_trajectory {
 public:
  /// Throws std::invalid_argument if the options are out of range, or there are neither a step nor
  /// frequencies or forces at the starts; std::runtime_error if the trajectory diverges.
  template <HasBath S, Ensemble<S> E>
    requires(S::dimension == N)
  one_long_trajectory(const S& system, const E& from, const long_trajectory_options& options = {})
      : held_(std::make_shared<detail::long_trajectory>(system, from, options)) {}

  std::size_t states() const { return held_->states(); }  ///< number of states kept

  /// The start of trajectory n: one of the states.
  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    const auto& x = (*held_)(seed, n);
    return {x.q, x.p};
  }

  std::string description() const { return held_->description(); }

 private:
  std::shared_ptr<const detail::long_trajectory> held_;
};

/// Takes the dimension from the system.
template <HasBath S, class E>
one_long_trajectory(const S&, const E&) -> one_long_trajectory<S::dimension>;
/// Takes the dimension from the system.
template <HasBath S, class E>
one_long_trajectory(const S&, const E&, const long_trajectory_options&) -> one_long_trajectory<S::dimension>;

}  // namespace nysalt
