// SPDX-License-Identifier: BSL-1.0
// A chain of Morse bonds, one of them much stiffer than the others.
#include <nysalt/plugin.hpp>

#include <cmath>
#include <string>

/// H = sum p_i^2/2 + sum V(bond): four masses between two walls, each bond V(r) = depth (1 - exp(-r))^2, the
/// third one of five with `stiffness` times the depth.
struct stiff_morse {
  static constexpr int dimension = 4;
  double stiffness = 100.0;

  template <class T>
  T potential(const nysalt::vector<T, dimension>& q) const {
    using std::exp;
    T sum(0.0);
    for (int i = 0; i <= dimension; ++i) {
      T bond(0.0);
      if (i < dimension) bond = bond + q[i];
      if (i > 0) bond = bond - q[i - 1];
      const T rest = 1.0 - exp(-bond);
      sum = sum + rest * rest * (i == 2 ? stiffness : 1.0);
    }
    return sum;
  }

  template <class T>
  void force(const nysalt::vector<T, dimension>& q, nysalt::vector<T, dimension>& f) const {
    using std::exp;
    for (int i = 0; i < dimension; ++i) f[i] = T(0.0);
    for (int i = 0; i <= dimension; ++i) {
      T bond(0.0);
      if (i < dimension) bond = bond + q[i];
      if (i > 0) bond = bond - q[i - 1];
      const T shrunk = exp(-bond);
      const T pull = (1.0 - shrunk) * shrunk * (i == 2 ? 2.0 * stiffness : 2.0);
      if (i < dimension) f[i] = f[i] - pull;
      if (i > 0) f[i - 1] = f[i - 1] + pull;
    }
  }
};

/// The masses at the ends of the stiff bond move together but for a tenth, as its energy would be 100 times
/// that of the others.
struct stiff_morse_law {
  double spread;

  nysalt::phase_point<double, 4> operator()(std::uint64_t seed, std::uint64_t n) const {
    const nysalt::vector<double, 4> rest = nysalt::vector<double, 4>::Zero();
    auto start = nysalt::normal_around<4>({rest, rest}, 0.1 * spread, 0.15 * spread)(seed, n);
    start.q[2] = start.q[1] + 0.1 * start.q[2];
    return start;
  }
  std::string description() const { return "stiff_morse_law(" + std::to_string(spread) + ")"; }
};

NYSALT_SYSTEM(
    stiff_morse, "Morse chain with one stiff bond",
    parameter("stiffness", &stiff_morse::stiffness, "of the third bond, in terms of the others").positive(),
    starts([](const stiff_morse&, double spread) { return stiff_morse_law{spread}; }),
    observable("first_bond", [](const stiff_morse&, const auto& x) { return x.q[0]; }));
