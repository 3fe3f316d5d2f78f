// SPDX-License-Identifier: BSL-1.0
// The kind of machine that measured.
#pragma once

#include <string>

namespace nysalt::program {

/// "AMD EPYC 9R14, 2 cores"; without the name of the machine.
std::string machine();

}  // namespace nysalt::program
