// SPDX-License-Identifier: BSL-1.0
// The ranks that mpirun started: how the program joins and leaves them.
#pragma once

#include <memory>
#include <string>

#include "comparison/all_ranks.hpp"

namespace nysalt::program {

/// Threads for a rank, if no number is asked: those of the cores that it may use, shared with other
/// ranks of the machine.
int usual_threads();

/// A warning where a rank has more threads than mpirun gave it cores, as is the default of mpirun;
/// empty if all is well.
std::string advice_on_threads(int threads);

/// Throws at all ranks unless all have the same text: options, or what they have read. Ranks that differ
/// would mix results, or wait for each other for ever.
void require_agreement(const std::string& what, const std::string& text);

/// Joins the other ranks, if the process was started as one of several and the program is built with MPI; to
/// be made once, in main(). To call MPI takes a tenth of a second, so that a process by itself does not.
class mpi_session {
 public:
  mpi_session(int argc, char** argv);
  ~mpi_session();
  mpi_session(const mpi_session&) = delete;
  mpi_session& operator=(const mpi_session&) = delete;

  /// Waits for the others and returns the exit code. A rank that ends with an error while others wait for it
  /// in the midst of their work ends them too, after some seconds.
  int leave(int code) const;

 private:
  class session;
  std::unique_ptr<session> session_;
};

/// Keeps the message of a rank that does not print, in case no other rank prints it.
void keep_unsaid(const std::string& text);

}  // namespace nysalt::program
