// SPDX-License-Identifier: BSL-1.0
#define NYSALT_TEST_EXTERN_OF_PARTS
#include "compiled_specimens.hpp"
