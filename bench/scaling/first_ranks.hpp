// SPDX-License-Identifier: BSL-1.0
// Some ranks of a job work while the others wait, so that one job measures all numbers of ranks in turn.
#pragma once

#include <mpi.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nysalt/communicators/mpi.hpp"

namespace nysalt::bench {

inline int rank_of_job() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}
inline int size_of_job() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// Ranks 0 .. size - 1 of the job.
class first_ranks {
 public:
  explicit first_ranks(int size) : size_(size) {
    MPI_Comm handle = MPI_COMM_NULL;
    MPI_Comm_split(MPI_COMM_WORLD, take_part() ? 0 : 1, rank_of_job(), &handle);
    ranks_.emplace(handle);  // of the other ranks, where this rank takes no part
    MPI_Comm_free(&handle);
  }

  int size() const { return size_; }
  bool take_part() const { return rank_of_job() < size_; }
  const communicator& ranks() const { return *ranks_; }

 private:
  int size_;
  std::optional<mpi_communicator> ranks_;
};

/// Asleep: who waits in MPI keeps a core busy.
inline void wait_for_all() {
  MPI_Request others = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &others);
  int all_there = 0;
  MPI_Test(&others, &all_there, MPI_STATUS_IGNORE);
  while (all_there == 0) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    MPI_Test(&others, &all_there, MPI_STATUS_IGNORE);
  }
}

/// From when all are there until this rank is done. What ends with a collective call ends with the slowest.
inline double seconds_of(const communicator& ranks, const std::function<void()>& work) {
  using clock = std::chrono::steady_clock;
  ranks.sum(0);
  const auto began = clock::now();
  work();
  return std::chrono::duration<double>(clock::now() - began).count();
}

/// A line a measurement.
inline void print_row(const nlohmann::ordered_json& row) {
  if (rank_of_job() == 0) fmt::print("{}\n", row.dump());
}

struct runner {
  nlohmann::ordered_json row;  // what it is
  const first_ranks* who;
  std::function<void()> work;
  int times = 1;  // that the work does the same, in a turn
};

/// In each round every runner has a turn, and then each again in the opposite order: a machine that slows
/// down slows all. Prints the seconds of each round.
inline void take_turns(const std::vector<runner>& runners, int rounds) {
  const auto turn = [](const runner& entry) {
    const double seconds = entry.who->take_part() ? seconds_of(entry.who->ranks(), entry.work) : 0.0;
    wait_for_all();
    return seconds / entry.times;
  };
  for (const runner& entry : runners) turn(entry);  // memory, threads
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> seconds;
    for (const runner& entry : runners) seconds.push_back(turn(entry));
    for (std::size_t i = runners.size(); i-- > 0;) seconds[i] = 0.5 * (seconds[i] + turn(runners[i]));
    for (std::size_t i = 0; i < runners.size(); ++i) {
      auto row = runners[i].row;
      row["round"] = round;
      row["seconds"] = seconds[i];
      print_row(row);
    }
  }
}

}  // namespace nysalt::bench
