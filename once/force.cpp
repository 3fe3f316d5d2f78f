// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/force_examination.hpp"
