// SPDX-License-Identifier: BSL-1.0
// In which coordinates an error of one step counts.
#include "nysalt/losses/metric.hpp"

namespace nysalt {

std::string to_string(coordinates c) {
  return c == coordinates::qp ? "qp" : c == coordinates::modes ? "modes" : "energy";
}

}  // namespace nysalt
