// expect: nysalt: a table must have letters of known_letters only
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/methods/tabulated.hpp"

/// A kick of twice the force that calls itself B.
struct strong_kick : nysalt::kick {
  static void apply(const auto&, const auto& c, auto& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += 2.0 * c * x.f[i];
  }
};

#ifdef NYSALT_CONTROL
using kicked = nysalt::kick;
#else
// [mistake]
using kicked = strong_kick;
// [/mistake]
#endif

struct method {
  using word = nysalt::word<kicked, nysalt::drift>;
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::array<double, 2> coefficients() { return {1.0, 1.0}; }
  static std::string name() { return "strong"; }
};

int main() { nysalt::tabulated table{method()}; }
