// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/error_measures/state.hpp"

#include <cstddef>
#include <vector>

namespace nysalt {

std::vector<detail::matrix_entry> detail::entries_of(const Eigen::MatrixXd& a) {
  std::vector<matrix_entry> result;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      if (a(i, j) != 0.0) result.push_back({static_cast<std::size_t>(i), j, a(i, j)});
    }
  }
  return result;
}

}  // namespace nysalt
