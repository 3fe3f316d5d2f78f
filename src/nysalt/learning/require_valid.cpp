// SPDX-License-Identifier: BSL-1.0
// What is said of data whose states are of another size.
#include "nysalt/learning/require_valid.hpp"

namespace nysalt::detail {

void refuse_size(const char* what, std::size_t n, Eigen::Index its, Eigen::Index wanted) {
  throw std::invalid_argument(
      sentence("{} {} of the data has not the dimension of the system: {} for {}", what, n, its, wanted));
}

}  // namespace nysalt::detail
