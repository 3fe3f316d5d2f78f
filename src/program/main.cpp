// SPDX-License-Identifier: BSL-1.0
#include "command_line.hpp"
#include "run_program.hpp"

int main(int argc, char** argv) {
  return nysalt::program::run_program(nysalt::program::run_command_line, argc, argv);
}
