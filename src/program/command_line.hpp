// SPDX-License-Identifier: BSL-1.0
// The command line: options, their help, and which command runs.
#pragma once

namespace nysalt::program {

/// Parses and runs. Returns the exit code; throws refusal for bad input.
int run_command_line(int argc, char** argv);

}  // namespace nysalt::program
