// SPDX-License-Identifier: BSL-1.0
// Systems that offer too little, or not in the required form. The comments are explained in check.py.
#include "common.hpp"
#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/detail/lockstep.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/pendulum.hpp"

// expect: nysalt: a separable system offers `template <class T> T potential(q)`, or `force(q, f)` as a
//   template or over double, const all of them; see nysalt/system.hpp
namespace system_without_force {
#ifdef NYSALT_CONTROL
using incomplete = well;
#else
struct incomplete {
  static constexpr int dimension = 1;
};
#endif
inline void use(const incomplete& system) { nysalt::make_stepper(system, nysalt::verlet(), 0.1); }
}  // namespace system_without_force

// expect: nysalt: a separable system offers `template <class T> T potential(q)`, or `force(q, f)` as a
//   template or over double, const all of them; see nysalt/system.hpp
namespace potential_over_double_alone {
#ifdef NYSALT_CONTROL
using not_differentiable = well;
#else
struct not_differentiable {
  static constexpr int dimension = 1;
  // [potential_over_double_alone]
  double potential(const nysalt::vector<double, 1>& q) const { return q[0] * q[0]; }
  // [/potential_over_double_alone]
};
#endif
inline void use(const not_differentiable& system) { nysalt::make_stepper(system, nysalt::verlet(), 0.1); }
}  // namespace potential_over_double_alone

// expect GNU: required for the satisfaction of 'System<S>' [with S = of_unknown_size]
// expect GNU: 'dimension' is not a member of 'of_unknown_size'
// expect Clang: because 'of_unknown_size' does not satisfy 'System'
// expect Clang: no member named 'dimension' in 'of_unknown_size'
namespace system_without_dimension {
struct of_unknown_size {
#ifdef NYSALT_CONTROL
  static constexpr int dimension = 1;
#endif
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
};
inline void use(const of_unknown_size& system) { nysalt::make_stepper(system, nysalt::verlet(), 0.1); }
}  // namespace system_without_dimension

// std::cos is for double alone; an unqualified cos finds that of dual numbers too.
// expect GNU: no matching function for call to 'cos(const nysalt::dual<double, 1>&)'
// expect Clang: no matching function for call to 'cos'
namespace function_of_std {
struct pendulum {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
#ifdef NYSALT_CONTROL
    using std::cos;
    return -cos(q[0]);
#else
    // [function_of_std]
    return -std::cos(q[0]);
    // [/function_of_std]
#endif
  }
};
inline void use(const pendulum& system) {
  nysalt::phase_point<double, 1> x{nysalt::vector<double, 1>(1.0), nysalt::vector<double, 1>(0.0)};
  nysalt::make_stepper(system, nysalt::verlet(), 0.1).step(x);
}
}  // namespace function_of_std

// One trajectory is beyond the wall and its neighbour is not: no branch serves both.
// expect: nysalt: lanes may differ in a comparison, so it cannot choose a branch: write
//   nysalt::select(condition, a, b), or let the system say `static constexpr int lanes = 1;`
namespace branch_between_lanes {
struct wall {
  static constexpr int dimension = 1;
#ifdef NYSALT_CONTROL
  static constexpr int lanes = 1;
#endif
  template <class T>
  void force(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& f) const {
    // [branch_between_lanes]
    if (q[0] < 0.0) {
      f[0] = q[0] * -100.0;
    } else {
      f[0] = T(0.0);
    }
    // [/branch_between_lanes]
  }
};
inline void use(const wall& system) {
  const auto stepper = nysalt::make_stepper(system, nysalt::verlet(), 0.01);
  using T = nysalt::scalar_of_lanes<nysalt::lanes_of<wall>>;
  const nysalt::phase_point<T, 1> start{nysalt::vector<T, 1>(T(1.0)), nysalt::vector<T, 1>(T(-1.0))};
  nysalt::lockstep<nysalt::stepper<wall, nysalt::verlet::word>, T>(stepper, start, 1).go_on(100);
}
}  // namespace branch_between_lanes

// expect: nysalt: inverse_mass is not of the form `double inverse_mass(Eigen::Index i) const`
namespace inverse_mass_not_const {
struct misdeclared : well {
#ifndef NYSALT_CONTROL
  // [inverse_mass_not_const]
  double inverse_mass(Eigen::Index) { return 0.5; }
  // [/inverse_mass_not_const]
#endif
};
inline void use(const misdeclared& system) { nysalt::make_stepper(system, nysalt::verlet(), 0.1); }
}  // namespace inverse_mass_not_const

// expect: nysalt: kinetic_energy is not of the form `template <class T> T kinetic_energy(p) const`
namespace kinetic_energy_not_const {
struct misdeclared : well {
#ifndef NYSALT_CONTROL
  // [kinetic_energy_not_const]
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 1>& p) {
    return p[0] * p[0];
  }
  // [/kinetic_energy_not_const]
#endif
};
inline void use(const misdeclared& system) { nysalt::make_stepper(system, nysalt::verlet(), 0.1); }
}  // namespace kinetic_energy_not_const

// expect: nysalt: kick is not of the form `template <class T, class C> void kick(q, p, c) const`
namespace kick_not_const {
struct misdeclared : well {
#ifndef NYSALT_CONTROL
  // [kick_not_const]
  template <class T, class C>
  void kick(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& p, const C& c) {
    p[0] -= q[0] * 2.0 * c;
  }
  // [/kick_not_const]
#endif
};
inline void use(const misdeclared& system) { nysalt::make_stepper(system, nysalt::verlet(), 0.1); }
}  // namespace kick_not_const

// expect: nysalt: frequency_bands is not of the form `std::vector<nysalt::frequency_band> frequency_bands()
//   const`
namespace frequency_bands_of_another_type {
struct misdeclared : well {
#ifndef NYSALT_CONTROL
  // [frequency_bands_of_another_type]
  std::vector<double> frequency_bands() const { return {1.0}; }
  // [/frequency_bands_of_another_type]
#endif
};
inline void use(const misdeclared& system) { nysalt::make_stepper(system, nysalt::verlet(), 0.1); }
}  // namespace frequency_bands_of_another_type

// expect: nysalt: bath is not of the form `const nysalt::bath& bath() const`; see systems/in_bath.hpp
namespace bath_of_another_type {
struct misdeclared : well {
#ifndef NYSALT_CONTROL
  // [bath_of_another_type]
  double bath() const { return 0.1; }
  // [/bath_of_another_type]
#endif
};
inline void use(const misdeclared& system) { nysalt::make_stepper(system, nysalt::baoab(), 0.1); }
}  // namespace bath_of_another_type

// expect: nysalt: velocity(p, v) must be differentiable, and takes double only; make it a template
namespace velocity_over_double_alone {
struct half_differentiable : well {
#ifndef NYSALT_CONTROL
  // [velocity_over_double_alone]
  void velocity(const nysalt::vector<double, 1>& p, nysalt::vector<double, 1>& v) const { v[0] = p[0] * 2.0; }
  // [/velocity_over_double_alone]
#endif
};
inline void use() {
  const nysalt::phase_point<double, 1> x{nysalt::vector<double, 1>(1.0), nysalt::vector<double, 1>(0.0)};
  nysalt::symplecticity_defect(half_differentiable(), nysalt::verlet(), 0.1, x);
}
}  // namespace velocity_over_double_alone

// expect GNU: required for the satisfaction of 'SeparableSystem<S>' [with S = incomplete]
// expect Clang: because 'incomplete' does not satisfy 'SeparableSystem'
namespace reference_of_a_system_without_force {
#ifdef NYSALT_CONTROL
using incomplete = well;
#else
struct incomplete {
  static constexpr int dimension = 1;
};
#endif
inline void use() {
  const nysalt::phase_point<double, 1> x{nysalt::vector<double, 1>(1.0), nysalt::vector<double, 1>(0.0)};
  nysalt::reference_error(incomplete(), nysalt::fine_steps<>(0.01), x, 0.1);
}
}  // namespace reference_of_a_system_without_force

// What models nothing is refused by the name of the concept, wherever it is handed over.
// expect: Scalar
// expect: System
// expect: Flow
// expect: Family
// expect: Method
// expect: NoiseSource
// expect: Ensemble
// expect: ReferenceFlow
namespace concepts_by_name {
struct nothing {};

#ifdef NYSALT_CONTROL
template <class Model, class Nothing>
using either = Model;
#else
template <class Model, class Nothing>
using either = Nothing;
#endif

using state = nysalt::phase_point<either<double, float>, 1>;
using letters = nysalt::word<either<nysalt::drift, nothing>, nysalt::kick>;
using family = nysalt::member<either<nysalt::nystrom, nothing>>;

inline void everything(const nysalt::pendulum& system, const either<nysalt::pendulum, nothing>& any_system,
                       const either<nysalt::verlet, nothing>& method,
                       const either<nysalt::no_noise, nothing>& noise,
                       const either<nysalt::listed<1>, nothing>& starts,
                       const either<nysalt::fine_steps<>, nothing>& reference,
                       const nysalt::phase_point<double, 1>& x) {
  nysalt::make_stepper(any_system, nysalt::verlet(), 0.1);
  nysalt::make_stepper(system, method, 0.1);
  nysalt::make_stepper(system, nysalt::verlet(), 0.1, noise);
  nysalt::sound_start(system, starts, 1, 0);
  nysalt::reference_error(system, reference, x, 0.1);
}
}  // namespace concepts_by_name
