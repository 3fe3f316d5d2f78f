// SPDX-License-Identifier: BSL-1.0
#define NYSALT_TEST_EXTERN
#include "compiled_models.hpp"
