// SPDX-License-Identifier: BSL-1.0
// Work of several ranks that succeeds on all of them, or fails on all.
#pragma once

#include <functional>

#include "nysalt/communicator.hpp"

namespace nysalt {

/// Does the work of this rank, in which nothing is collective. If it throws on some ranks, it throws on all
/// what the lowest of them threw, as std::invalid_argument, std::bad_alloc or std::runtime_error with its
/// words; on a single rank, the very exception. So all ranks catch it, or none does. Lower ranks have lower
/// trajectories, so that it is the exception of the first that has one, as in for_each_block(). Cost: one
/// number from and to all ranks.
void collectively(const communicator& ranks, const std::function<void()>& work);

/// The same of what only rank 0 does, such as writing a file. Meanwhile the others leave it the processor.
void on_first(const communicator& ranks, const std::function<void()>& work);

}  // namespace nysalt
