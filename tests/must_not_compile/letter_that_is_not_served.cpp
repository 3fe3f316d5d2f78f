// expect: nysalt: the system does not serve a letter of the word
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/stepper.hpp"
#include "nysalt/systems/pendulum.hpp"

/// A letter of one's own, for some systems only.
struct pull {
  static constexpr char letter = 'U';
  static constexpr std::size_t slots = 1;
  static constexpr nysalt::field reads = nysalt::field::none;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = false;
  static constexpr bool additive = true;
#ifdef NYSALT_CONTROL
  template <nysalt::System S, nysalt::Scalar T>
  static constexpr bool serves = true;
#else
  // [mistake]
  template <nysalt::System S, nysalt::Scalar T>
  static constexpr bool serves = S::dimension > 1;
  // [/mistake]
#endif
  template <nysalt::Scalar C>
  static C prepare(const C& c, double h) {
    return c * h;
  }
  static void apply(const auto&, const auto& c, auto& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += c;
  }
};

int main() {
  const nysalt::pendulum system;
  nysalt::stepper<nysalt::pendulum, nysalt::word<pull, nysalt::drift>>(system, {1.0, 1.0}, 0.1);
}
