// SPDX-License-Identifier: BSL-1.0

#include "nysalt/communicator.hpp"

#include <cstdint>
#include <exception>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>

#include "nysalt/atomic_file.hpp"

namespace nysalt {

namespace {

enum class failure : int { bad_argument, no_memory, not_written, other };

failure describe_thrown(const std::exception_ptr& thrown, std::string& text) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::invalid_argument& problem) {
    text = problem.what();
    return failure::bad_argument;
  } catch (const std::bad_alloc&) {
    return failure::no_memory;
  } catch (const detail::write_failure& problem) {
    text = problem.what();
    return failure::not_written;
  } catch (const std::exception& problem) {
    text = problem.what();
  } catch (...) {
    text = "an unknown exception";
  }
  return failure::other;
}

}  // namespace

void collectively(const communicator& ranks, const std::function<void()>& work) {
  if (ranks.is_single()) {
    work();
    return;
  }
  std::exception_ptr thrown;
  try {
    work();
  } catch (...) {
    thrown = std::current_exception();
  }
  const auto lowest = static_cast<int>(ranks.minimum(thrown ? ranks.rank() : ranks.size()));
  if (lowest == ranks.size()) return;
  std::string text;
  auto kind = failure::other;
  if (ranks.rank() == lowest) kind = describe_thrown(thrown, text);
  broadcast(ranks, kind, lowest);
  broadcast(ranks, text, lowest);
  if (kind == failure::bad_argument) throw std::invalid_argument(text);
  if (kind == failure::no_memory) throw std::bad_alloc();
  if (kind == failure::not_written) throw detail::write_failure(text);
  throw std::runtime_error(text);
}

void on_first(const communicator& ranks, const std::function<void()>& work) {
  struct meeting {
    const communicator& ranks;
    ~meeting() { ranks.barrier(); }  // whether or not the work succeeds
  };
  collectively(ranks, [&] {
    const meeting at_end{ranks};
    if (ranks.is_first()) work();
  });
}

progress_callback detail::progress_of_share(const communicator& ranks, std::int64_t count, std::int64_t total,
                                            const progress_callback& progress) {
  if (!progress || ranks.is_single()) return progress;
  if (!ranks.is_first()) return {};
  return [progress, count, total](std::int64_t done) {
    const double share = static_cast<double>(done) / static_cast<double>(count);
    progress(static_cast<std::int64_t>(share * static_cast<double>(total)));
  };
}

}  // namespace nysalt
