// SPDX-License-Identifier: BSL-1.0
// A few states of data, wherever they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "nysalt/flow_map_data.hpp"

namespace nysalt {

/// The starts of some pairs of all, by their numbers, which rise: at all ranks, for what is asked along them.
template <int N>
std::vector<phase_point<double, N>> starts_of(const flow_map_data<N>& data, Eigen::Index dimension,
                                              const std::vector<std::size_t>& pairs) {
  const auto size = static_cast<std::size_t>(dimension);
  std::vector<double> numbers;  // q and p of one after the other
  for (const std::size_t pair : pairs) {
    if (pair < data.first_pair() || pair >= data.first_pair() + data.pairs()) continue;
    const auto& x = data.start[pair - data.first_pair()];
    numbers.insert(numbers.end(), x.q.begin(), x.q.end());
    numbers.insert(numbers.end(), x.p.begin(), x.p.end());
  }
  numbers = one_after_the_other(data.share().ranks(), numbers);
  std::vector<phase_point<double, N>> result;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double* q = numbers.data() + 2 * size * k;
    result.push_back({Eigen::Map<const vector<double, N>>(q, dimension),
                      Eigen::Map<const vector<double, N>>(q + size, dimension)});
  }
  return result;
}

/// The starts of some hundred pairs, evenly spread: at all ranks.
template <int N>
std::vector<phase_point<double, N>> some_states(const flow_map_data<N>& data, Eigen::Index dimension) {
  constexpr std::size_t most = 128;
  std::vector<std::size_t> pairs;
  const std::size_t all = data.all_pairs();
  for (std::size_t n = 0; n < all; n += all / most + 1) pairs.push_back(n);
  return starts_of(data, dimension, pairs);
}

}  // namespace nysalt
