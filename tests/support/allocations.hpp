// SPDX-License-Identifier: BSL-1.0
// Counts allocations of the whole program, for tests that promise none. Include it in one file of a program.
#pragma once

#include <cstddef>

#include "sanitizers.hpp"

namespace nysalt::test {
inline std::size_t allocations = 0;
inline std::size_t allocated_bytes = 0;  // whether given back or not
}  // namespace nysalt::test

#if NYSALT_TEST_HAS_FEATURE(address_sanitizer)
// AddressSanitizer wraps malloc itself, and crashes where others do: it tells of each allocation.
#include <sanitizer/allocator_interface.h>
namespace nysalt::test {
inline void count_allocation(const volatile void*, std::size_t size) {
  ++allocations;
  allocated_bytes += size;
}
inline void count_nothing(const volatile void*) {}
inline const int installed = __sanitizer_install_malloc_and_free_hooks(count_allocation, count_nothing);
}  // namespace nysalt::test
#elif !NYSALT_TEST_HAS_FEATURE(thread_sanitizer)
// Eigen's storage comes from malloc, and so does that of operator new. glibc lets a program wrap it by name.
extern "C" void* __libc_malloc(std::size_t);
// Weak, as several objects of a program may include this.
extern "C" [[gnu::visibility("default"), gnu::weak]] void* malloc(std::size_t size) {
  ++nysalt::test::allocations;
  nysalt::test::allocated_bytes += size;
  return __libc_malloc(size);
}
#endif
