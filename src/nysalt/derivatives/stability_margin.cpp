// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/stability_margin.hpp"

#include <fmt/format.h>

namespace nysalt {

std::string in_words(const resonance& near) {
  return fmt::format(
      "h omega comes within {:g} % of {}pi for the frequencies {:.4g} to {:.4g}: in runs of more than {} "
      "steps "
      "energies may drift; take steps up to {:.3g}, or from {:.3g} on",
      100.0 * resonance_distance, near.half_turns == 1 ? "" : fmt::format("{} ", near.half_turns),
      near.band.low, near.band.high, long_run, near.near.low, near.near.high);
}

}  // namespace nysalt
