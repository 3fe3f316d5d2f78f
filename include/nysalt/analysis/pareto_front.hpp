// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace nysalt {

/// A point of a diagram of cost and error, in any units.
struct cost_and_error {
  double cost;   ///< less is better
  double error;  ///< less is better
};

/// The Pareto front: points of which no other has less or as much of both. Of equals the first counts; what
/// is not finite never does. Indices, by rising cost and falling error. Cost: a sort.
std::vector<std::size_t> pareto_front(std::span<const cost_and_error> all);

}  // namespace nysalt
