// SPDX-License-Identifier: BSL-1.0
#include "shared_wave.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <optional>
#include <span>

#include "nysalt/detail/together.hpp"

namespace nysalt::program {

namespace {

template <class Number>
void send(const communicator& ranks, const std::vector<Number>& numbers, int to) {
  if (!numbers.empty()) ranks.send(std::as_bytes(std::span(numbers)), to);
}
template <class Number>
std::vector<Number> receive(const communicator& ranks, std::int64_t count, int from) {
  std::vector<Number> numbers(static_cast<std::size_t>(count));
  if (count > 0) ranks.receive(std::as_writable_bytes(std::span(numbers)), from);
  return numbers;
}

constexpr std::int64_t not_lost = -1;
std::int64_t number_of(std::optional<std::int64_t> lost) { return lost.value_or(not_lost); }
std::optional<std::int64_t> loss_of(std::int64_t number) {
  return number == not_lost ? std::nullopt : std::optional(number);
}

}  // namespace

shared_wave::shared_wave(std::int64_t first, std::int64_t count, int lanes, const communicator& ranks)
    : first_(first), count_(count), lanes_(lanes), ranks_(&ranks) {}

std::int64_t shared_wave::first_of(int rank) const {
  const std::int64_t blocks = (count_ + lanes_ - 1) / lanes_;
  return first_ + std::min(count_, first_of_part(blocks, rank, ranks_->size()) * lanes_);
}

void shared_wave::hand_over(const std::vector<record>& own,
                            const std::function<void(std::int64_t, const record&)>& take) const {
  std::exception_ptr problem;  // others send what they have all the same
  const auto hand_on = [&](std::int64_t m, const record& one) {
    if (problem || (one.values.empty() && !one.diverged_at)) return;
    try {
      take(m, one);
    } catch (...) {
      problem = std::current_exception();
    }
  };
  if (ranks_->is_first()) {
    for (std::size_t i = 0; i < own.size(); ++i) hand_on(first_ + static_cast<std::int64_t>(i), own[i]);
    for (int r = 1; r < ranks_->size(); ++r) {
      const std::int64_t count_of_rank = first_of(r + 1) - first_of(r);
      const auto heads = receive<std::int64_t>(*ranks_, 3 * count_of_rank, r);
      for (std::int64_t i = 0; i < count_of_rank; ++i) {
        const std::int64_t* head = heads.data() + 3 * i;
        hand_on(first_of(r) + i, {head[0], receive<double>(*ranks_, head[1], r), loss_of(head[2])});
      }
    }
  } else {
    std::vector<std::int64_t> heads;
    for (const auto& one : own) {
      heads.insert(heads.end(), {one.first, std::ssize(one.values), number_of(one.diverged_at)});
    }
    send(*ranks_, heads, 0);
    for (const auto& one : own) send(*ranks_, one.values, 0);
  }
  together(*ranks_, [&] {
    if (problem) std::rethrow_exception(problem);
  });
}

saved_runs shared_wave::gather(saved_runs own) const {
  if (!ranks_->is_first()) {
    std::vector<std::int64_t> losses;
    for (const auto& one : own.diverged_at) losses.push_back(number_of(one));
    losses.push_back(std::ssize(own.numbers));
    send(*ranks_, losses, 0);
    send(*ranks_, own.numbers, 0);
    return {};
  }
  saved_runs all = std::move(own);
  for (int r = 1; r < ranks_->size(); ++r) {
    auto losses = receive<std::int64_t>(*ranks_, first_of(r + 1) - first_of(r) + 1, r);
    const auto numbers = receive<double>(*ranks_, losses.back(), r);
    losses.pop_back();
    for (const std::int64_t one : losses) all.diverged_at.push_back(loss_of(one));
    all.numbers.insert(all.numbers.end(), numbers.begin(), numbers.end());
  }
  return all;
}

saved_runs shared_wave::scatter(const saved_runs& all) const {
  if (ranks_->is_alone()) return all;
  saved_runs own{all.step, {}, {}};
  broadcast(*ranks_, own.step);
  std::int64_t each = ranks_->is_first() ? std::ssize(all.numbers) / count_ : 0;
  broadcast(*ranks_, each);
  for (int r = 0; r < ranks_->size(); ++r) {
    const std::int64_t count_of_rank = first_of(r + 1) - first_of(r);
    std::vector<std::int64_t> losses;
    std::vector<double> numbers;
    if (ranks_->is_first()) {
      const auto from = first_of(r) - first_;
      for (std::int64_t i = 0; i < count_of_rank; ++i) {
        losses.push_back(number_of(all.diverged_at[static_cast<std::size_t>(from + i)]));
      }
      numbers.assign(all.numbers.begin() + from * each, all.numbers.begin() + (from + count_of_rank) * each);
      if (r > 0) send(*ranks_, losses, r);
      if (r > 0) send(*ranks_, numbers, r);
    } else if (ranks_->rank() == r) {
      losses = receive<std::int64_t>(*ranks_, count_of_rank, 0);
      numbers = receive<double>(*ranks_, count_of_rank * each, 0);
    }
    if (ranks_->rank() != r) continue;
    for (const std::int64_t one : losses) own.diverged_at.push_back(loss_of(one));
    own.numbers = std::move(numbers);
  }
  return own;
}

}  // namespace nysalt::program
