// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/communicator.hpp"

namespace nysalt {

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

}  // namespace nysalt
