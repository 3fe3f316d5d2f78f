// SPDX-License-Identifier: BSL-1.0
#include "nysalt/model.hpp"

#include <stdexcept>

namespace nysalt {

namespace detail {
void refuse_kernel() { throw std::logic_error("model: the system does not serve this function"); }

template <int Lanes>
void library_is_compiled_for() {}
template void library_is_compiled_for<default_lanes>();
}  // namespace detail

Eigen::MatrixXd model::kinetic_hessian(const Eigen::VectorXd& p) const {
  using D = detail::slopes;
  const Eigen::Index n = size();
  vector<D, dimension> lifted(n);
  vector<D, dimension> v(n);
  Eigen::MatrixXd hessian(n, n);
  for (Eigen::Index i = 0; i < n; ++i) lifted[i] = D(p[i]);
  for (Eigen::Index j = 0; j < n; ++j) {
    lifted[j] = D::variable(p[j], 0);
    kernels<D>().velocity(lifted, v);
    lifted[j] = D(p[j]);
    for (Eigen::Index i = 0; i < n; ++i) hessian(i, j) = v[i].derivative[0];
  }
  return hessian;
}

}  // namespace nysalt
