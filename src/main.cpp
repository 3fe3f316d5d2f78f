// SPDX-License-Identifier: BSL-1.0
#include <csignal>

#include "run_program.hpp"

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // print() ends quietly when a reader has seen enough
  return nysalt::program::run_program(argc, argv);
}
