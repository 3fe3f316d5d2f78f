// SPDX-License-Identifier: BSL-1.0
// The part that needs Boost.Odeint: references by its steppers, and methods as its steppers.
#pragma once

#include "nysalt/references/odeint.hpp"
