// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensemble_threads.hpp"
