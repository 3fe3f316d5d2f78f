// expect: there must be as many pieces as holes
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/sentence.hpp"

#ifdef NYSALT_CONTROL
const auto words = nysalt::sentence("{} of {}", 1, 2);
#else
const auto words = nysalt::sentence("{} of {}", 1);
#endif
