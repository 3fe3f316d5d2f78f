// SPDX-License-Identifier: BSL-1.0
// Counts allocations of the whole program, for tests that promise none. Include it in one file of a program.
#pragma once

#include <cstddef>

#include "sanitizers.hpp"

namespace nysalt::test {
inline std::size_t allocations = 0;
inline std::size_t allocated_bytes = 0;  // whether given back or not
}  // namespace nysalt::test

// Sanitizers wrap malloc themselves, and crash where others do: under them nothing is counted.
#if !defined NYSALT_ADDRESS_SANITIZER && !defined NYSALT_THREAD_SANITIZER
// Eigen's storage comes from malloc, and so does that of operator new. glibc lets a program wrap it by name.
extern "C" void* __libc_malloc(std::size_t);
extern "C" [[gnu::visibility("default")]] void* malloc(std::size_t size) {
  ++nysalt::test::allocations;
  nysalt::test::allocated_bytes += size;
  return __libc_malloc(size);
}
#endif
