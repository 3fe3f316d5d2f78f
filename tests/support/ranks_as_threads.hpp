// SPDX-License-Identifier: BSL-1.0
// Ranks in one process, each a thread: what ranks do together can be tested without MPI.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "nysalt/communicator.hpp"

namespace nysalt::test {

/// What passed at one rank.
struct traffic {
  std::int64_t sent = 0;      // messages
  std::int64_t received = 0;  // messages
  std::int64_t together = 0;  // collective calls
  std::int64_t bytes = 0;     // in and out; of a collective call, of what the rank has after it
};

/// The letter boxes between all ranks.
class post {
 public:
  void put(int from, int to, std::span<const std::byte> message) {
    const std::lock_guard lock(guard_);
    boxes_[{from, to}].emplace_back(message.begin(), message.end());
    arrived_.notify_all();
  }
  void take(int from, int to, std::span<std::byte> message) {
    std::unique_lock lock(guard_);
    auto& box = boxes_[{from, to}];
    arrived_.wait(lock, [&] { return !box.empty(); });
    if (box.front().size() != message.size()) throw std::logic_error("a message of another length");
    std::ranges::copy(box.front(), message.begin());
    box.pop_front();
  }

 private:
  std::mutex guard_;
  std::condition_variable arrived_;
  std::map<std::pair<int, int>, std::deque<std::vector<std::byte>>> boxes_;
};

class thread_communicator final : public communicator {
 public:
  thread_communicator(post& between, int rank, int size) : between_(&between), rank_(rank), size_(size) {}

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void send(std::span<const std::byte> message, int to) const override {
    ++seen_.sent;
    seen_.bytes += std::ssize(message);
    between_->put(rank_, to, message);
  }
  void receive(std::span<std::byte> message, int from) const override {
    ++seen_.received;
    seen_.bytes += std::ssize(message);
    between_->take(from, rank_, message);
  }
  void broadcast(std::span<std::byte> message, int from) const override {
    ++seen_.together;
    seen_.bytes += std::ssize(message);
    for (int r = 0; rank_ == from && r < size_; ++r) {
      if (r != from) between_->put(from, r, message);
    }
    if (rank_ != from) between_->take(from, rank_, message);
  }
  void all_gather(std::span<std::byte> all, std::span<const std::size_t> first_of) const override {
    ++seen_.together;
    seen_.bytes += std::ssize(all);
    const auto part = [&](int r) {
      const auto at = static_cast<std::size_t>(r);
      return all.subspan(first_of[at], first_of[at + 1] - first_of[at]);
    };
    for (int r = 0; r < size_; ++r) {
      if (r != rank_) between_->put(rank_, r, part(rank_));
    }
    for (int r = 0; r < size_; ++r) {
      if (r != rank_) between_->take(r, rank_, part(r));
    }
  }
  std::int64_t minimum(std::int64_t value) const override { return std::ranges::min(values_of_all(value)); }
  std::int64_t sum(std::int64_t value) const override {
    std::int64_t sum = 0;
    for (const std::int64_t term : values_of_all(value)) sum += term;
    return sum;
  }

  void barrier() const override { sum(0); }

  const traffic& seen() const { return seen_; }

 private:
  std::vector<std::int64_t> values_of_all(std::int64_t value) const {
    std::vector<std::int64_t> all(static_cast<std::size_t>(size_));
    std::vector<std::size_t> first_of;
    for (std::size_t r = 0; r <= all.size(); ++r) first_of.push_back(r * sizeof(value));
    all[static_cast<std::size_t>(rank_)] = value;
    all_gather(std::as_writable_bytes(std::span(all)), first_of);
    return all;
  }

  post* between_;
  int rank_;
  int size_;
  mutable traffic seen_;
};

/// Rank r as it sees itself: for what is asked of no other.
inline thread_communicator rank_alone(int rank, int size) {
  static post nowhere;
  return {nowhere, rank, size};
}

/// Calls body(ranks) once on each rank; what the lowest rank that throws throws leaves this. A rank that
/// throws alone, where others wait for it, would wait for ever: so would MPI.
inline void run_ranks(int size, const std::function<void(const thread_communicator&)>& body) {
  post between;
  std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(size));
  std::vector<std::jthread> all;
  for (int r = 0; r < size; ++r) {
    all.emplace_back([&, r] {
      try {
        body(thread_communicator(between, r, size));
      } catch (...) {
        thrown[static_cast<std::size_t>(r)] = std::current_exception();
      }
    });
  }
  for (auto& one : all) one.join();
  for (const auto& exception : thrown) {
    if (exception) std::rethrow_exception(exception);
  }
}

}  // namespace nysalt::test
