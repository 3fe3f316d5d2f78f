// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/gibbs.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace nysalt {

double detail::temperature_to_sample(const bath& its) {
  if (!its.has_temperature()) {
    throw std::invalid_argument(
        fmt::format("gibbs: a {} has no temperature; give one, or friction", its.description()));
  }
  if (its.temperature() > 0.0) return its.temperature();
  throw std::invalid_argument(
      "gibbs: at temperature 0 a system rests where its potential is least, and there is nothing to "
      "sample; start from "
      "another ensemble");
}

}  // namespace nysalt
