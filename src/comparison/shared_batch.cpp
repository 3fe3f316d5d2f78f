// SPDX-License-Identifier: BSL-1.0
#include "shared_batch.hpp"

#include <cstddef>
#include <exception>
#include <optional>
#include <span>

#include "nysalt/communicator.hpp"

namespace nysalt::program {

namespace {

template <class Item>
void send(const communicator& ranks, const std::vector<Item>& items, int to) {
  if (!items.empty()) ranks.send(std::as_bytes(std::span(items)), to);
}
template <class Item>
std::vector<Item> receive(const communicator& ranks, std::int64_t count, int from) {
  std::vector<Item> items(static_cast<std::size_t>(count));
  if (count > 0) ranks.receive(std::as_writable_bytes(std::span(items)), from);
  return items;
}

/// A record without its values.
struct record_head {
  std::int64_t first;
  std::int64_t values;  // how many
  std::optional<std::int64_t> diverged_at;
};

void send_runs(const communicator& ranks, const saved_runs& runs, int to) {
  send(ranks, std::vector{runs.step, std::int64_t{std::ssize(runs.numbers)}}, to);
  send(ranks, runs.diverged_at, to);
  send(ranks, runs.numbers, to);
}
saved_runs receive_runs(const communicator& ranks, std::int64_t count, int from) {
  const auto head = receive<std::int64_t>(ranks, 2, from);
  const auto diverged_at = receive<std::optional<std::int64_t>>(ranks, count, from);
  return {head[0], receive<double>(ranks, head[1], from), diverged_at};
}

}  // namespace

shared_batch::shared_batch(std::int64_t first, std::int64_t count, int lanes, const communicator& ranks)
    : first_(first), share_(count, ranks, lanes), ranks_(&ranks) {}

void shared_batch::deliver(const std::vector<record>& own, const record_taker& take) const {
  std::exception_ptr problem;  // others send what they have all the same
  const auto deliver_one = [&](std::int64_t m, const record& one) {
    if (problem || (one.values.empty() && !one.diverged_at)) return;
    try {
      take(m, one);
    } catch (...) {
      problem = std::current_exception();
    }
  };
  if (ranks_->is_first()) {
    for (std::size_t i = 0; i < own.size(); ++i) deliver_one(first_ + static_cast<std::int64_t>(i), own[i]);
    for (int r = 1; r < ranks_->size(); ++r) {
      std::int64_t m = first_of(r);
      for (const auto& head : receive<record_head>(*ranks_, first_of(r + 1) - m, r)) {
        deliver_one(m++, {head.first, receive<double>(*ranks_, head.values, r), head.diverged_at});
      }
    }
  } else {
    std::vector<record_head> heads;
    for (const auto& one : own) heads.push_back({one.first, std::ssize(one.values), one.diverged_at});
    send(*ranks_, heads, 0);
    for (const auto& one : own) send(*ranks_, one.values, 0);
  }
  collectively(*ranks_, [&] {
    if (problem) std::rethrow_exception(problem);
  });
}

saved_runs shared_batch::gather(saved_runs own) const {
  if (!ranks_->is_first()) {
    send_runs(*ranks_, own, 0);
    return {};
  }
  for (int r = 1; r < ranks_->size(); ++r) {
    const saved_runs part = receive_runs(*ranks_, first_of(r + 1) - first_of(r), r);
    own.diverged_at.insert(own.diverged_at.end(), part.diverged_at.begin(), part.diverged_at.end());
    own.numbers.insert(own.numbers.end(), part.numbers.begin(), part.numbers.end());
  }
  return own;
}

saved_runs shared_batch::scatter(const saved_runs& all) const {
  if (!ranks_->is_first()) return receive_runs(*ranks_, count(), 0);
  const auto part_of = [&](int r) {
    const std::int64_t begin = first_of(r) - first_;
    const std::int64_t end = first_of(r + 1) - first_;
    const std::int64_t each = std::ssize(all.numbers) / share_.total();
    return saved_runs{all.step,
                      {all.numbers.begin() + begin * each, all.numbers.begin() + end * each},
                      {all.diverged_at.begin() + begin, all.diverged_at.begin() + end}};
  };
  for (int r = 1; r < ranks_->size(); ++r) send_runs(*ranks_, part_of(r), r);
  return part_of(0);
}

}  // namespace nysalt::program
