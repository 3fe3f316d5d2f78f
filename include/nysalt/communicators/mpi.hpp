// SPDX-License-Identifier: BSL-1.0
// Processes on one machine or many, by the Message Passing Interface. Needs nysalt::mpi.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <thread>
#include <vector>

#include "nysalt/communicator.hpp"

namespace nysalt {

/// The ranks of an MPI communicator, by default of all processes that mpirun started. MPI must be initialised
/// before, and finalised after; calls come from the thread that did so (MPI_THREAD_FUNNELED). What MPI finds
/// wrong ends all processes, as is its custom, and so does a message of another length than is expected.
/// Messages do not mix with messages of others, as the communicator is a duplicate. MPI counts in int, so
/// that longer messages go in pieces of `longest` bytes.
class mpi_communicator final : public communicator {
 public:
  /// Collective, as it makes the duplicate; `longest` must be below 2^31.
  explicit mpi_communicator(MPI_Comm ranks = MPI_COMM_WORLD, std::size_t longest = std::size_t{1} << 30U)
      : longest_(longest) {
    MPI_Comm_dup(ranks, &ranks_);
    MPI_Comm_rank(ranks_, &rank_);
    MPI_Comm_size(ranks_, &size_);
  }
  ~mpi_communicator() override { MPI_Comm_free(&ranks_); }
  mpi_communicator(const mpi_communicator&) = delete;
  mpi_communicator& operator=(const mpi_communicator&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void send(std::span<const std::byte> message, int to) const override {
    in_pieces(message, [&](auto piece, int length) { MPI_Send(piece, length, MPI_BYTE, to, 0, ranks_); });
  }
  void receive(std::span<std::byte> message, int from) const override {
    in_pieces(message, [&](auto piece, int length) {
      MPI_Status seen;
      MPI_Recv(piece, length, MPI_BYTE, from, 0, ranks_, &seen);
      int arrived = 0;
      MPI_Get_count(&seen, MPI_BYTE, &arrived);
      if (arrived != length) MPI_Abort(ranks_, MPI_ERR_COUNT);
    });
  }
  void broadcast(std::span<std::byte> message, int from) const override {
    in_pieces(message, [&](auto piece, int length) { MPI_Bcast(piece, length, MPI_BYTE, from, ranks_); });
  }

  void all_gather(std::span<std::byte> all, std::span<const std::size_t> first_of) const override {
    if (all.size() > longest_) {
      for (int r = 0; r < size_; ++r) {
        const auto at = static_cast<std::size_t>(r);
        broadcast(all.subspan(first_of[at], first_of[at + 1] - first_of[at]), r);
      }
      return;
    }
    std::vector<int> lengths;
    std::vector<int> begins;
    for (std::size_t r = 0; r + 1 < first_of.size(); ++r) {
      lengths.push_back(static_cast<int>(first_of[r + 1] - first_of[r]));
      begins.push_back(static_cast<int>(first_of[r]));
    }
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all.data(), lengths.data(), begins.data(), MPI_BYTE,
                   ranks_);
  }

  std::int64_t minimum(std::int64_t value) const override { return reduced(value, MPI_MIN); }
  std::int64_t sum(std::int64_t value) const override { return reduced(value, MPI_SUM); }

  void barrier() const override {
    MPI_Request others;
    MPI_Ibarrier(ranks_, &others);
    int all_there = 0;
    MPI_Test(&others, &all_there, MPI_STATUS_IGNORE);
    while (all_there == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      MPI_Test(&others, &all_there, MPI_STATUS_IGNORE);
    }
  }

 private:
  template <class Byte, class Pass>
  void in_pieces(std::span<Byte> message, const Pass& pass) const {
    for (std::size_t done = 0; done < message.size(); done += longest_) {
      pass(message.data() + done, static_cast<int>(std::min(longest_, message.size() - done)));
    }
  }

  std::int64_t reduced(std::int64_t value, MPI_Op how) const {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, how, ranks_);
    return value;
  }

  MPI_Comm ranks_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
  std::size_t longest_;
};

}  // namespace nysalt
