// SPDX-License-Identifier: BSL-1.0
// The sanitizers of clang++ that a test is compiled with.
#pragma once

#if defined __has_feature
#if __has_feature(address_sanitizer)
#define NYSALT_ADDRESS_SANITIZER
#endif
#if __has_feature(thread_sanitizer)
#define NYSALT_THREAD_SANITIZER
#endif
#endif

namespace nysalt::test {
#if defined NYSALT_ADDRESS_SANITIZER
constexpr bool under_address_sanitizer = true;
#else
constexpr bool under_address_sanitizer = false;
#endif
#if defined NYSALT_THREAD_SANITIZER
constexpr bool under_thread_sanitizer = true;
#else
constexpr bool under_thread_sanitizer = false;
#endif
}  // namespace nysalt::test
