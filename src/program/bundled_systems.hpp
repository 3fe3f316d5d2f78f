// SPDX-License-Identifier: BSL-1.0
// The bundled systems: each is declared in its own file below systems/.
#pragma once

#include <vector>

#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// In the order of `list`.
const std::vector<system_declaration>& bundled_declarations();

}  // namespace nysalt::program
