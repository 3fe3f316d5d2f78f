// SPDX-License-Identifier: BSL-1.0
#include "mpi_session.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <sched.h>
#include <unistd.h>

#include <fmt/format.h>

#include "comparison/refusal.hpp"
#include "comparison/standard_error.hpp"
#include "nysalt/communicator.hpp"

#if defined NYSALT_HAS_MPI
#include "nysalt/communicators/mpi.hpp"
#endif

namespace nysalt::program {

namespace {
std::string unsaid;
}

void keep_unsaid(const std::string& text) { unsaid = text; }

void require_agreement(const std::string& what, const std::string& text) {
  if (all_ranks().is_single()) return;
  std::string of_first = text;
  broadcast(all_ranks(), of_first);
  collectively(all_ranks(), [&] {
    if (text == of_first) return;
    refuse(
        "rank {} must have the {} of rank 0; start all ranks with one command line, where all see the same "
        "files",
        all_ranks().rank(), what);
  });
}

#if defined NYSALT_HAS_MPI

namespace {

/// Whether a launcher made this process one of several: Open MPI's own, or one that speaks PMIx or PMI.
bool was_launched() {
  return std::ranges::any_of(
      std::initializer_list<const char*>{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"},
      [](const char* name) { return std::getenv(name) != nullptr; });
}

int ranks_of_machine() {
  MPI_Comm ranks;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &ranks);
  int size = 1;
  MPI_Comm_size(ranks, &size);
  MPI_Comm_free(&ranks);
  return size;
}

int ranks_here = 1;

}  // namespace

class mpi_session::session {
 public:
  session(int argc, char** argv) : mpi_(argc, argv) {
    join(ranks_);
    ranks_here = ranks_of_machine();
  }
  ~session() { join(one_rank); }

 private:
  struct initialised {
    initialised(int argc, char** argv) {
      int granted = 0;
      MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &granted);
    }
    ~initialised() { MPI_Finalize(); }
  };
  initialised mpi_;  // before the ranks, and after them
  mpi_communicator ranks_;
};

mpi_session::mpi_session(int argc, char** argv) {
  if (was_launched()) session_ = std::make_unique<session>(argc, argv);
}
mpi_session::~mpi_session() = default;

int mpi_session::leave(int code) const {
  if (!session_) return code;
  using clock = std::chrono::steady_clock;
  constexpr auto patience = std::chrono::seconds(10);
  const auto began = clock::now();
  MPI_Request others;
  MPI_Ibarrier(MPI_COMM_WORLD, &others);
  for (int all_there = 0; true; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
    MPI_Test(&others, &all_there, MPI_STATUS_IGNORE);
    if (all_there != 0) return code;
    if (code == 0 || clock::now() - began < patience) continue;
    if (!unsaid.empty()) to_standard_error(fmt::format("nysalt: rank {}: {}\n", all_ranks().rank(), unsaid));
    MPI_Abort(MPI_COMM_WORLD, code);
  }
}

#else

namespace {
constexpr int ranks_here = 1;
}

class mpi_session::session {};
mpi_session::mpi_session(int, char**) {}
mpi_session::~mpi_session() = default;
int mpi_session::leave(int code) const { return code; }

#endif

namespace {
/// Cores that this process may use.
int cores() {
  cpu_set_t cpus;
  if (sched_getaffinity(0, sizeof cpus, &cpus) != 0) return 1;  // of more than 1024
  return std::max(1, CPU_COUNT(&cpus));
}
bool is_bound() { return cores() < static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)); }
}  // namespace

int usual_threads() { return is_bound() ? cores() : std::max(1, cores() / ranks_here); }

std::string advice_on_threads(int threads) {
  if (all_ranks().is_single() || !is_bound() || threads <= cores()) return {};
  return fmt::format(
      "each rank has {} threads and may use {} core{}; start mpirun with --bind-to none, or --map-by "
      "slot:PE={}",
      threads, cores(), cores() == 1 ? "" : "s", threads);
}

}  // namespace nysalt::program
