// SPDX-License-Identifier: BSL-1.0
// Ranks that share the work, and the messages that pass between them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace nysalt {

/// The ranks of a program from the view of one of them: rank r of size(). All that is
/// not send() and receive() is collective: every rank calls it, in the same order. A message has the length
/// that its receiver expects. A rank that leaves a collective function by an exception which the others do
/// not throw, as when only that rank is out of memory, leaves them waiting: it must end the job.
class communicator {
 public:
  virtual ~communicator() = default;

  virtual int rank() const = 0;  ///< number of this process, from 0
  virtual int size() const = 0;  ///< number of processes

  /// Sends a message. Between two ranks messages arrive in the order in which they were sent. send() may wait
  /// for receive().
  virtual void send(std::span<const std::byte> message, int to) const = 0;
  /// Waits for the next message of rank `from`, as long as `message` is.
  virtual void receive(std::span<std::byte> message, int from) const = 0;

  /// Copies the message of one rank to all.
  virtual void broadcast(std::span<std::byte> message, int from) const = 0;
  /// Rank r has bytes first_of[r] .. first_of[r + 1] - 1 of `all`; all get the rest.
  virtual void all_gather(std::span<std::byte> all, std::span<const std::size_t> first_of) const = 0;
  virtual std::int64_t minimum(std::int64_t value) const = 0;  ///< the least of the values of all ranks
  virtual std::int64_t sum(std::int64_t value) const = 0;      ///< the sum of the values of all ranks
  /// Waits until all ranks have called barrier(). The other calls may burn their processor while they wait,
  /// as what comes soon is there sooner then; this one leaves it to those that work, and takes some
  /// milliseconds.
  virtual void barrier() const = 0;

  bool is_first() const { return rank() == 0; }   ///< whether this is rank 0
  bool is_single() const { return size() == 1; }  ///< whether there are no others
};

/// A value that is its bytes, from one rank to all.
template <class T>
  requires std::is_trivially_copyable_v<T>
void broadcast(const communicator& ranks, T& value, int from = 0) {
  ranks.broadcast(std::as_writable_bytes(std::span(&value, 1)), from);
}
/// A text or list, which may have another length at the others.
template <class List>
  requires std::is_trivially_copyable_v<typename List::value_type>
void broadcast(const communicator& ranks, List& values, int from = 0) {
  auto length = static_cast<std::int64_t>(values.size());
  broadcast(ranks, length, from);
  values.resize(static_cast<std::size_t>(length));
  ranks.broadcast(std::as_writable_bytes(std::span(values)), from);
}

namespace detail {

/// Rank r has items first_of[r] .. first_of[r + 1] - 1 of `all`; all get the rest.
template <class Item>
  requires std::is_trivially_copyable_v<Item>
void all_gather_items(const communicator& ranks, std::vector<Item>& all, std::vector<std::size_t> first_of) {
  for (std::size_t& first : first_of) first *= sizeof(Item);  // now bytes
  ranks.all_gather(std::as_writable_bytes(std::span(all)), first_of);
}

}  // namespace detail

/// All-gather of one value of each rank.
template <class T>
  requires std::is_trivially_copyable_v<T>
std::vector<T> all_gather(const communicator& ranks, const T& value) {
  std::vector<T> all(static_cast<std::size_t>(ranks.size()));
  std::vector<std::size_t> first_of;
  for (std::size_t r = 0; r <= all.size(); ++r) first_of.push_back(r);
  all[static_cast<std::size_t>(ranks.rank())] = value;
  detail::all_gather_items(ranks, all, first_of);
  return all;
}

/// All-gather of lists: the items of rank 0, then the items of rank 1, and so on.
template <class T>
  requires std::is_trivially_copyable_v<T>
std::vector<T> all_gather(const communicator& ranks, const std::vector<T>& ours) {
  std::vector<std::size_t> first_of{0};
  for (const std::size_t count : all_gather(ranks, ours.size())) {
    first_of.push_back(first_of.back() + count);
  }
  std::vector<T> all(first_of.back());
  const std::size_t first = first_of[static_cast<std::size_t>(ranks.rank())];
  std::copy(ours.begin(), ours.end(), all.begin() + static_cast<std::ptrdiff_t>(first));
  detail::all_gather_items(ranks, all, first_of);
  return all;
}

namespace detail {

/// Item first_of_part(count, r, parts) is the first that part r has of `count`: parts are as equal as can be,
/// and part 0 has one if any has.
inline std::int64_t first_of_part(std::int64_t count, int part, int parts) {
  return (count * part + parts - 1) / parts;
}

}  // namespace detail

// [one_rank]
/// The communicator of a single process: no messages.
class lone_communicator final : public communicator {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  void send(std::span<const std::byte>, int) const override {}
  void receive(std::span<std::byte>, int) const override {}
  void broadcast(std::span<std::byte>, int) const override {}
  void all_gather(std::span<std::byte>, std::span<const std::size_t>) const override {}
  std::int64_t minimum(std::int64_t value) const override { return value; }
  std::int64_t sum(std::int64_t value) const override { return value; }
  void barrier() const override {}
};

inline const lone_communicator one_rank;  ///< default communicator of all options
// [/one_rank]

// Work of several ranks that succeeds on all of them, or fails on all.

/// Does the work of this rank, in which nothing is collective. If it throws on some ranks, it throws on all
/// what the lowest of them threw, as std::invalid_argument, std::bad_alloc or std::runtime_error with its
/// words; on a single rank, the very exception. So all ranks catch it, or none does. Lower ranks have lower
/// trajectories, so that it is the exception of the first that has one, as in for_each_block(). Cost: one
/// number from and to all ranks.
void collectively(const communicator& ranks, const std::function<void()>& work);

/// The same of what only rank 0 does, such as writing a file. Meanwhile the others leave it the processor.
void on_first(const communicator& ranks, const std::function<void()>& work);

// One rank's progress, reported as the progress of all ranks.

/// A function that is called with the number of trajectories done, after some of them, unless the options say
/// what is counted; from any thread, but calls do not overlap. Empty where progress is not reported.
using progress_callback = std::function<void(std::int64_t done)>;

namespace detail {

/// A counter for the `count` trajectories of this rank, such that `progress` counts to `total`, the number of
/// trajectories of all ranks. Shares are nearly equal: rank 0 scales its own count, and the others report
/// nothing.
progress_callback progress_of_share(const communicator& ranks, std::int64_t count, std::int64_t total,
                                    const progress_callback& progress);

}  // namespace detail

}  // namespace nysalt
