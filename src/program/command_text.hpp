// SPDX-License-Identifier: BSL-1.0
// A command line as a shell would take it again.
#pragma once

#include <string>

namespace nysalt::program {

std::string command_text(int argc, char** argv);

}  // namespace nysalt::program
