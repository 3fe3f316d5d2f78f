// SPDX-License-Identifier: BSL-1.0
// Counts allocations of the whole program, for tests that promise none. Include it in one file of a program.
#pragma once

#include <cstddef>

namespace nysalt::test {
inline std::size_t allocations = 0;
}

// Eigen's storage comes from malloc, and so does that of operator new. glibc lets a program wrap it by name.
extern "C" void* __libc_malloc(std::size_t);
extern "C" [[gnu::visibility("default")]] void* malloc(std::size_t size) {
  ++nysalt::test::allocations;
  return __libc_malloc(size);
}
