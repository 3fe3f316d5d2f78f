// SPDX-License-Identifier: BSL-1.0
#include <csignal>

#include "../plugin/named_signals.hpp"
#include "mpi_session.hpp"
#include "run_program.hpp"

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // print() ends quietly when a reader has seen enough
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is told as a full disk is
  nysalt::program::allow_named_signals();
  const nysalt::program::mpi_session ranks(argc, argv);
  return ranks.leave(nysalt::program::run_program(argc, argv));
}
