// SPDX-License-Identifier: BSL-1.0

#include "nysalt/core/sentence.hpp"

#include <fmt/format.h>

namespace nysalt {

std::string detail::in_digits(double x, int digits) { return fmt::format("{:.{}g}", x, digits); }

}  // namespace nysalt
