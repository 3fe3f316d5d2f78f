// SPDX-License-Identifier: BSL-1.0
// The sanitizers of clang++ that a test is compiled with.
#pragma once

#if defined __has_feature
#define NYSALT_TEST_HAS_FEATURE(feature) __has_feature(feature)
#else
#define NYSALT_TEST_HAS_FEATURE(feature) 0
#endif

namespace nysalt::test {
constexpr bool under_address_sanitizer = NYSALT_TEST_HAS_FEATURE(address_sanitizer);
}  // namespace nysalt::test
