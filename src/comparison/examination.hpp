// SPDX-License-Identifier: BSL-1.0
// What is looked at in a system that a user declares.
#pragma once

namespace nysalt::program {

/// Names of observables are checked always.
enum class examination {
  whole,           ///< energy and force at some starts; the frequency where none is declared
  frequency_only,  ///< the frequency, which a method is fitted to
  none
};

}  // namespace nysalt::program
