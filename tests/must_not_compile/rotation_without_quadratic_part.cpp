// expect: nysalt: the letters R, S, H need a system that declares a quadratic part: modes() and soft_force(q,
//   f), see nysalt/system.hpp
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flows/rotation.hpp"
#include "nysalt/stepper.hpp"

struct spring {
  static constexpr int dimension = 1;
  template <class T>
  void force(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& f) const {
    f[0] = -q[0];
  }
  nysalt::normal_modes modes() const { return {Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Ones(1)}; }
#ifdef NYSALT_CONTROL
  template <class T>
  void soft_force(const nysalt::vector<T, 1>&, nysalt::vector<T, 1>& f) const {
    f[0] = T(0.0);
  }
#endif
};

int main() {
  const spring system;
  // [mistake]
  using impulse = nysalt::word<nysalt::soft_kick, nysalt::rotation, nysalt::soft_kick>;
  nysalt::stepper<spring, impulse>(system, {0.5, 1.0, 0.5}, 0.1);
  // [/mistake]
}
