// SPDX-License-Identifier: BSL-1.0
#include <csignal>
#include <exception>

#include "../plugin/named_signals.hpp"
#include "commands.hpp"
#include "comparison/interruption.hpp"
#include "mpi_session.hpp"
#include "output.hpp"
#include "run_program.hpp"

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // print() ends quietly when a reader has seen enough
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is reported like a full disk
  nysalt::program::allow_named_signals();
  try {
    const nysalt::program::mpi_session ranks(argc, argv);
    nysalt::program::handle_signals();  // after MPI, which may have handlers of its own
    return ranks.leave(nysalt::program::run_program(argc, argv));
  } catch (const std::exception& problem) {
    nysalt::program::complain(problem.what());
  } catch (...) {
    nysalt::program::complain("cannot go on: something was thrown that is no std::exception");
  }
  return nysalt::program::bad_input;
}
