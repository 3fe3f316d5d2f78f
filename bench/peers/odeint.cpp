// SPDX-License-Identifier: BSL-1.0
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/base/symplectic_rkn_stepper_base.hpp>
#include <boost/numeric/odeint/stepper/velocity_verlet.hpp>
#include <boost/numeric/odeint/util/resizer.hpp>
#include <functional>
#include <utility>

#include "two_stage.hpp"

namespace nysalt::bench {

namespace {

namespace odeint = boost::numeric::odeint;

/// The force of the FPU chain, as dp/dt and as the acceleration that velocity_verlet asks for.
struct force {
  double k;

  template <class T>
  void operator()(const std::array<T, 6>& q, std::array<T, 6>& f) const {
    const auto quartic = [](const T& u) __attribute__((always_inline)) { return T(u * u * u * 4.0); };
    T left = quartic(q[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const T stiff = (q[2 * i + 1] - q[2 * i]) * k;
      const T right = quartic(i < 2 ? T(q[2 * i + 2] - q[2 * i + 1]) : T(-q[2 * i + 1]));
      f[2 * i] = stiff - left;
      f[2 * i + 1] = right - stiff;
      left = right;
    }
  }
  void operator()(const std::array<double, 6>& q, const std::array<double, 6>&, std::array<double, 6>& f,
                  double /*t*/) const {
    (*this)(q, f);
  }
};

/// A(a[0]) B(b[0]) A(a[1]) B(b[1]) ...
template <std::size_t Stages, class T>
class nystrom_stepper
    : public odeint::symplectic_nystroem_stepper_base<
          Stages, 2, std::array<T, 6>, std::array<T, 6>, double, std::array<T, 6>, std::array<T, 6>, double,
          odeint::array_algebra, odeint::default_operations, odeint::initially_resizer> {
 public:
  using coefficients = boost::array<double, Stages>;
  nystrom_stepper(const coefficients& a, const coefficients& b)
      : nystrom_stepper::symplectic_nystroem_stepper_base(a, b) {}
};

template <std::size_t Stages, class T>
void steps_of(nystrom_stepper<Stages, T> stepper, const force& f, chain_state<T>& x, std::int64_t steps) {
  auto state = std::make_pair(x.q, x.p);
  for (std::int64_t n = 0; n < steps; ++n) stepper.do_step(std::cref(f), state, 0.0, 1.0);
  x = {state.first, state.second};
}

template <class T>
void synchronous(std::span<chain_state<T>> states, const two_stage& c, std::int64_t steps) {
  const nystrom_stepper<3, T> stepper({{c.a1, c.a2, c.a3}}, {{c.b1, c.b2, 0.0}});
  for (auto& x : states) steps_of(stepper, force{c.k}, x, steps);
}

template <class T>
void merged(std::span<chain_state<T>> states, const two_stage& c, std::int64_t steps) {
  const nystrom_stepper<2, T> stepper({{c.a3 + c.a1, c.a2}}, {{c.b1, c.b2}});
  const auto drift = [](chain_state<T>& x, double a) {
    for (std::size_t i = 0; i < 6; ++i) x.q[i] += x.p[i] * a;
  };
  for (auto& x : states) {
    drift(x, -c.a3);
    steps_of(stepper, force{c.k}, x, steps);
    drift(x, c.a3);
  }
}

}  // namespace

template <>
void odeint_two_stage<this_build>(std::span<chain_state<double>> states, const two_stage& c,
                                  std::int64_t steps) {
  synchronous(states, c, steps);
}
template <>
void odeint_two_stage<this_build>(std::span<chain_state<lanes>> states, const two_stage& c,
                                  std::int64_t steps) {
  synchronous(states, c, steps);
}
template <>
void odeint_merged<this_build>(std::span<chain_state<double>> states, const two_stage& c,
                               std::int64_t steps) {
  merged(states, c, steps);
}
template <>
void odeint_merged<this_build>(std::span<chain_state<lanes>> states, const two_stage& c, std::int64_t steps) {
  merged(states, c, steps);
}

template <>
void odeint_verlet<this_build>(chain_state<double>& x, double k, double h, std::int64_t steps) {
  odeint::velocity_verlet<std::array<double, 6>> stepper;
  const force f{k};
  auto state = std::make_pair(x.q, x.p);
  for (std::int64_t n = 0; n < steps; ++n) {
    stepper.do_step(std::cref(f), state, static_cast<double>(n) * h, h);
  }
  x = {state.first, state.second};
}

template <>
void odeint_verlet_aba<this_build>(chain_state<double>& x, double k, double h, std::int64_t steps) {
  const nystrom_stepper<2, double> stepper({{0.5 * h, 0.5 * h}}, {{h, 0.0}});
  steps_of(stepper, force{k}, x, steps);
}

}  // namespace nysalt::bench
