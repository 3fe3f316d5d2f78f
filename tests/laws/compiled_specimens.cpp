// SPDX-License-Identifier: BSL-1.0
#define NYSALT_TEST_EXTERN_SPECIMEN
#include "compiled_specimens.hpp"
