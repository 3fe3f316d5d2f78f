// SPDX-License-Identifier: BSL-1.0
// The whole program but for main(): every failure becomes one line and an exit code.
#pragma once

#include <functional>

namespace nysalt::program {

/// The exit code of the work, or bad_input after an exception was reported. Throws nothing.
int exit_code_of(const std::function<int()>& work);

/// The exit code: done, bad_input, no_result or not_written of commands.hpp, or 128 and the number of the
/// signal that ended the work. Throws nothing.
int run_program(int argc, char** argv);

}  // namespace nysalt::program
