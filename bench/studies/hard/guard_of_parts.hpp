// SPDX-License-Identifier: BSL-1.0
// What the guard says of words with kicks of parts, beside what long runs of them do, over a class of
// systems.
#pragma once

#include "hard_case.hpp"

namespace nysalt::hard {

/// Chains and coupled oscillators of several sizes and stiffnesses, r-RESPA and learned words, and many
/// steps.
verdict guard_of_slow_kicks(extent how);

}  // namespace nysalt::hard
