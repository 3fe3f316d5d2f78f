// SPDX-License-Identifier: BSL-1.0
// Work of several ranks that succeeds on all of them, or fails on all.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>

#include "nysalt/communicator.hpp"

namespace nysalt {

namespace detail {

enum class failure : int { bad_argument, no_memory, other };

inline failure describe_thrown(const std::exception_ptr& thrown, std::string& text) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::invalid_argument& its) {
    text = its.what();
    return failure::bad_argument;
  } catch (const std::bad_alloc&) {
    return failure::no_memory;
  } catch (const std::exception& its) {
    text = its.what();
  } catch (...) {
    text = "an unknown exception";
  }
  return failure::other;
}

}  // namespace detail

/// Does the work of this rank, in which nothing is collective. If it throws on some ranks, it throws on all
/// what the lowest of them threw, as std::invalid_argument, std::bad_alloc or std::runtime_error with its
/// words; alone, the very exception. So all ranks catch it, or none does. Lower ranks have lower
/// trajectories, so that it is the exception of the first that has one, as in for_each_block(). Cost: one
/// number from and to all ranks.
inline void together(const communicator& ranks, const std::function<void()>& work) {
  if (ranks.is_alone()) {
    work();
    return;
  }
  std::exception_ptr thrown;
  try {
    work();
  } catch (...) {
    thrown = std::current_exception();
  }
  const auto lowest = static_cast<int>(ranks.least(thrown ? ranks.rank() : ranks.size()));
  if (lowest == ranks.size()) return;
  std::string text;
  auto kind = detail::failure::other;
  if (ranks.rank() == lowest) kind = detail::describe_thrown(thrown, text);
  broadcast(ranks, kind, lowest);
  broadcast(ranks, text, lowest);
  if (kind == detail::failure::bad_argument) throw std::invalid_argument(text);
  if (kind == detail::failure::no_memory) throw std::bad_alloc();
  throw std::runtime_error(text);
}

/// The same of what rank 0 alone does, such as writing a file. Meanwhile the others leave it the processor.
inline void on_first(const communicator& ranks, const std::function<void()>& work) {
  struct meeting {
    const communicator& ranks;
    ~meeting() { ranks.meet(); }  // whether or not the work succeeds
  };
  together(ranks, [&] {
    const meeting at_end{ranks};
    if (ranks.is_first()) work();
  });
}

}  // namespace nysalt
