// SPDX-License-Identifier: BSL-1.0
#include "metropolis.hpp"

#include <cmath>
#include <stdexcept>

#include "nysalt/detail/sentence.hpp"

namespace nysalt::detail {

void require_metropolis_applies(const char* who, const model& system, const tabulated& method,
                                double temperature) {
  if (!method.symmetric) {
    throw std::invalid_argument(
        sentence("{}: the method must be reversible, or Hybrid Monte Carlo samples another distribution, got "
                 "{}; take a symmetric method",
                 who, method.name()));
  }
  if (system.bath().acts()) {
    throw std::invalid_argument(
        sentence("{}: H must be conserved, got {}; take the system without its bath", who, describe(system)));
  }
  if (!(temperature > 0.0) || !std::isfinite(temperature)) {
    throw std::invalid_argument(sentence("{}: kT must be positive and finite, got {}", who, temperature));
  }
}

}  // namespace nysalt::detail
