// SPDX-License-Identifier: BSL-1.0
// nysalt_paper: every table and figure of the paper beside what comes out here.
#include <csignal>

#include "command_line.hpp"
#include "program/mpi_session.hpp"
#include "program/run_program.hpp"

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // print() ends quietly when a reader has seen enough
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is reported like a full disk
  const nysalt::program::mpi_session ranks(argc, argv);
  return ranks.leave(
      nysalt::program::exit_code_of([&] { return nysalt::program::paper::run_command_line(argc, argv); }));
}
