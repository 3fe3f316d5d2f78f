// SPDX-License-Identifier: BSL-1.0
// A system of one's own for the program: nysalt build toda.hpp
// [system]
#include <nysalt/plugin.hpp>

#include <cmath>

/// The Toda lattice: a ring of particles, each bond V(r) = exp(r) - 1 - r.
struct toda {
  static constexpr int dimension = Eigen::Dynamic;
  long particles = 16;

  Eigen::Index size() const { return particles; }

  template <class T>
  T potential(const nysalt::vector<T, dimension>& q) const {
    using std::exp;
    T sum(0.0);
    for (Eigen::Index i = 0; i < particles; ++i) {
      const T bond = q[(i + 1) % particles] - q[i];
      sum = sum + (exp(bond) - 1.0 - bond);
    }
    return sum;
  }
  template <class T>
  void force(const nysalt::vector<T, dimension>& q, nysalt::vector<T, dimension>& f) const {
    using std::exp;
    for (Eigen::Index i = 0; i < particles; ++i) f[i] = T(0.0);
    for (Eigen::Index i = 0; i < particles; ++i) {
      const Eigen::Index next = (i + 1) % particles;
      const T pull = exp(q[next] - q[i]) - 1.0;
      f[i] = f[i] + pull;
      f[next] = f[next] - pull;
    }
  }
};
// [/system]

// [declaration]
NYSALT_SYSTEM(toda, "a ring of particles, each bond exp(r) - 1 - r",
              parameter("particles", &toda::particles, "in the ring").at_least(2).at_most(1000).size(),
              starts([](const toda& ring, double spread) {
                const Eigen::VectorXd rest = Eigen::VectorXd::Zero(ring.particles);
                return normal_around<Eigen::Dynamic>({rest, rest}, 0.3 * spread, 0.5 * spread);
              }),
              observable("first_bond", [](const toda&, const auto& x) { return x.q[1] - x.q[0]; }));
// [/declaration]
