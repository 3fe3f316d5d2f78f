// SPDX-License-Identifier: BSL-1.0
// A start of a search where the highest frequency is known.
#include "nysalt/families/phase_fitted_start.hpp"

#include <cmath>
#include <stdexcept>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/families/phase_fitting.hpp"

namespace nysalt {

std::optional<named_parameters> phase_fitted_start(const run_time_family& family, double z) {
  if (!(z > 0.0) || !std::isfinite(z)) {
    throw std::invalid_argument(sentence(
        "phase_fitted_start: z = step * frequency must be positive and finite, got {}; fit to a mode that "
        "moves",
        z));
  }
  const auto is_classical = [](const named_parameters& one) {
    return one.name != "start" && one.name != "further start";
  };
  for (const bool classical : {true, false}) {
    for (const auto& one : family.starts) {
      if (is_classical(one) != classical) continue;
      if (const auto fit = detail::fit_phase(family, one.theta, z); fit.theta) {
        return named_parameters{"phase_fitted", *fit.theta};
      }
    }
  }
  return std::nullopt;
}

}  // namespace nysalt
