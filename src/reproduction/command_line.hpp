// SPDX-License-Identifier: BSL-1.0
// The command line of nysalt_paper.
#pragma once

namespace nysalt::program::paper {

/// Parses and runs. Returns the exit code; throws refusal for bad input.
int run_command_line(int argc, char** argv);

}  // namespace nysalt::program::paper
