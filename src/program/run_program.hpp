// SPDX-License-Identifier: BSL-1.0
// What main() of a program does: every failure becomes one line and an exit code.
#pragma once

namespace nysalt::program {

/// Reads a command line, does what it asks for, and returns the exit code. May throw.
using command_line = int (*)(int argc, char** argv);

/// The exit code of a command line: done, bad_input, no_result or not_written of commands.hpp, or 128 and the
/// number of the signal that ended the work. Throws nothing.
int exit_code_of(command_line run, int argc, char** argv);

/// The same as all that main() does: signals are handled, and the ranks of mpirun joined and left. Once in a
/// process. Throws nothing.
int run_program(command_line run, int argc, char** argv);

}  // namespace nysalt::program
