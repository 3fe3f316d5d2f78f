// SPDX-License-Identifier: BSL-1.0
#include "nysalt/losses/after_steps.hpp"

namespace nysalt {

template class after_steps<detail::lanes>;
template class after_steps<double>;

}  // namespace nysalt
