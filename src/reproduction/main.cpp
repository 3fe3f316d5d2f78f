// SPDX-License-Identifier: BSL-1.0
// nysalt_paper: every table and figure of the paper beside what comes out here.
#include "command_line.hpp"
#include "program/run_program.hpp"

int main(int argc, char** argv) {
  return nysalt::program::run_program(nysalt::program::paper::run_command_line, argc, argv);
}
