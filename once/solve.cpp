// SPDX-License-Identifier: BSL-1.0
#include "nysalt/learning/solve.hpp"
#include "eigen.hpp"
