// SPDX-License-Identifier: BSL-1.0
// Names that users may give to a system, its parameters and its observables.
#pragma once

#include <string>
#include <string_view>

#include "comparison/user_system_checks.hpp"

namespace nysalt::program {

std::string in_lower_case(std::string_view text);

/// A name that no parameter may have, as files, options or arguments of Python use it for something else.
bool is_reserved_name(std::string_view name);

}  // namespace nysalt::program
