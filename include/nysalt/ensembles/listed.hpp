// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"

namespace nysalt {

/// Given states, in their order; the seed is of no account.
template <int N>
class listed {
 public:
  /// Trajectory n starts at states[n].
  explicit listed(std::vector<phase_point<double, N>> states) : states_(std::move(states)) {}

  /// Throws std::out_of_range beyond the last state.
  phase_point<double, N> operator()(std::uint64_t, std::uint64_t n) const {
    if (n >= states_.size()) {
      throw std::out_of_range(sentence("listed: an initial state must be in the list, got number {} of {}",
                                       n + 1, states_.size()));
    }
    return states_[n];
  }
  std::size_t size() const { return states_.size(); }  ///< number of states
  std::string description() const { return sentence("listed({} states)", states_.size()); }

 private:
  std::vector<phase_point<double, N>> states_;
};

}  // namespace nysalt
