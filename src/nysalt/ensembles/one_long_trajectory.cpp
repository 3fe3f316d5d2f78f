// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/one_long_trajectory.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace nysalt {

void detail::require_long_trajectory(const long_trajectory_options& o, double step) {
  const bool times = step > 0.0 && o.burn_in >= 0.0 && o.length > o.burn_in && o.length / step < 1e12;
  if (times && o.most_states >= 1 && o.most_states <= 100'000) return;
  throw std::invalid_argument(
      fmt::format("one_long_trajectory: length {}, burn-in {}, step {} and {} states: cannot be; the step "
                  "is positive, the "
                  "burn-in shorter than the length, the states 1 to 100000",
                  o.length, o.burn_in, step, o.most_states));
}

}  // namespace nysalt
