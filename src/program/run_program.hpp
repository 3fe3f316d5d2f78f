// SPDX-License-Identifier: BSL-1.0
// The whole program but for its main(): whatever goes wrong becomes one line and an exit code.
#pragma once

namespace nysalt::program {

/// The exit code: done, bad_input or no_result of commands.hpp. Throws nothing.
int run_program(int argc, char** argv);

}  // namespace nysalt::program
