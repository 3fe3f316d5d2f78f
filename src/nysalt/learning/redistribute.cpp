// SPDX-License-Identifier: BSL-1.0
// Trajectories of data that go to other ranks.
#include "redistribute.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace nysalt::detail {

namespace {

/// All doubles of trajectories begin .. end - 1 of this rank, by their places here: how many finer finishes
/// there are and of which of these pairs, then states and noise.
std::vector<double> packed(const flow_map_data& data, std::size_t begin, std::size_t end) {
  std::vector<double> numbers;
  const auto add = [&](const auto& values) { numbers.insert(numbers.end(), values.begin(), values.end()); };
  const auto add_state = [&](const auto& x) {
    add(x.q);
    add(x.p);
  };
  const std::size_t first = data.first_of[begin];
  const std::size_t last = data.first_of[end];
  numbers.push_back(static_cast<double>(end - begin));
  for (std::size_t m = begin; m < end; ++m) {
    numbers.push_back(static_cast<double>(data.first_of[m + 1] - data.first_of[m]));
  }
  const auto is_here = [&](const auto& finer_finish) {
    return first <= finer_finish.first && finer_finish.first < last;
  };
  numbers.push_back(static_cast<double>(std::ranges::count_if(data.finer, is_here)));
  for (const auto& finer_finish : data.finer) {
    if (!is_here(finer_finish)) continue;
    numbers.push_back(static_cast<double>(finer_finish.first - first));
    add_state(finer_finish.second);
  }
  const auto parts = static_cast<std::size_t>(data.noise_parts);
  for (std::size_t n = first; n < last; ++n) {
    add_state(data.start[n]);
    add_state(data.finish[n]);
    for (std::size_t k = 0; k < parts; ++k) add(data.noise[n * parts + k]);
  }
  return numbers;
}

/// Puts them behind those that there are.
void unpack(std::span<const double> numbers, Eigen::Index dimension, flow_map_data& data) {
  const auto take = [&] {
    const double x = numbers.front();
    numbers = numbers.subspan(1);
    return x;
  };
  const auto take_count = [&] { return static_cast<std::size_t>(take()); };
  const auto take_vector = [&] {
    Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(numbers.data(), dimension);
    numbers = numbers.subspan(static_cast<std::size_t>(dimension));
    return x;
  };
  const auto take_state = [&] {
    phase_point<double, Eigen::Dynamic> x;
    x.q = take_vector();
    x.p = take_vector();
    return x;
  };
  const std::size_t first = data.pairs();
  const std::size_t trajectories = take_count();
  for (std::size_t m = 0; m < trajectories; ++m) data.first_of.push_back(data.first_of.back() + take_count());
  const std::size_t finer = take_count();
  for (std::size_t k = 0; k < finer; ++k) {
    const std::size_t pair = first + take_count();
    data.finer.emplace_back(pair, take_state());
  }
  while (data.pairs() < data.first_of.back()) {
    data.start.push_back(take_state());
    data.finish.push_back(take_state());
    for (int k = 0; k < data.noise_parts; ++k) data.noise.push_back(take_vector());
  }
}

}  // namespace

void redistribute(flow_map_data& data, const shard& next, Eigen::Index dimension) {
  const shard now = data.share();
  const communicator& ranks = next.ranks();
  if (ranks.is_single()) return;
  flow_map_data kept;
  kept.first_of = {0};
  kept.noise_parts = data.noise_parts;
  for (int from = 0; from < ranks.size(); ++from) {
    for (int to = 0; to < ranks.size(); ++to) {
      if (from != ranks.rank() && to != ranks.rank()) continue;
      const std::int64_t begin = std::max(now.first_of(from), next.first_of(to));
      const std::int64_t end = std::min(now.first_of(from + 1), next.first_of(to + 1));
      if (begin >= end) continue;
      std::vector<double> numbers;
      if (from == ranks.rank()) {
        const auto place = [&](std::int64_t m) { return static_cast<std::size_t>(m - now.first()); };
        numbers = packed(data, place(begin), place(end));
      }
      if (from != to) {
        auto length = static_cast<std::int64_t>(numbers.size());
        const std::span length_message(&length, 1);
        if (from == ranks.rank()) {
          ranks.send(std::as_bytes(length_message), to);
          ranks.send(std::as_bytes(std::span(numbers)), to);
          continue;
        }
        ranks.receive(std::as_writable_bytes(length_message), from);
        numbers.resize(static_cast<std::size_t>(length));
        ranks.receive(std::as_writable_bytes(std::span(numbers)), from);
      }
      unpack(numbers, dimension, kept);
    }
  }
  data.start = std::move(kept.start);
  data.finish = std::move(kept.finish);
  data.noise = std::move(kept.noise);
  data.first_of = std::move(kept.first_of);
  data.finer = std::move(kept.finer);
}

}  // namespace nysalt::detail
