// expect: a hole is {}, without a format
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/sentence.hpp"

#ifdef NYSALT_CONTROL
const auto words = nysalt::sentence("step {}", 0.1);
#else
const auto words = nysalt::sentence("step {:.3}", 0.1);
#endif
