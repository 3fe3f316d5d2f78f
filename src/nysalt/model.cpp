// SPDX-License-Identifier: BSL-1.0
#include "nysalt/model.hpp"

#include <stdexcept>

namespace nysalt::detail {

void refuse_kernel() { throw std::logic_error("model: the system does not serve this function"); }

}  // namespace nysalt::detail
