// SPDX-License-Identifier: BSL-1.0
// A charged particle in a Penning trap: the flow in the magnetic field, and methods of it.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "nysalt/core/sentence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/method.hpp"

namespace examples {

using namespace nysalt;

struct cyclotron_flow;
struct velocity_drift;
struct boris_turn;

/// A particle of unit mass and charge in a uniform magnetic field along the third axis and an electric
/// potential, a system of three degrees of freedom with a force:
///   H = |v|^2/2 + V(q),  v = p - A(q),  A = frequency/2 (-q_2, q_1, 0),
/// so that v' = force(q) + frequency (v_2, -v_1, 0). The momenta are the canonical ones, in which words of
/// flows are symplectic. H does not separate: words of letters A and B do not step it; those of
/// cyclotron_flow, or boris, and kick_of_part<0>, the electric one, do.
template <System Potential>
  requires(Potential::dimension == 3)
class charged_particle {
 public:
  static constexpr int dimension = 3;
  static constexpr std::size_t parts = 1;  ///< the electric potential, for kick_of_part<0>
  using letters = std::tuple<cyclotron_flow, velocity_drift, boris_turn, kick_of_part<0>>;

  /// Throws std::invalid_argument unless the cyclotron frequency is finite and not zero.
  charged_particle(const Potential& electric, double cyclotron_frequency)
      : electric_(electric), frequency_(cyclotron_frequency) {
    if (cyclotron_frequency == 0.0 || !std::isfinite(cyclotron_frequency)) {
      throw std::invalid_argument(
          sentence("charged_particle: the cyclotron frequency must be finite and not zero, got {}; without a "
                   "magnetic field take the potential as the system",
                   cyclotron_frequency));
    }
  }

  /// The electric potential; there is no other part.
  template <std::size_t I>
    requires(I == 0)
  const Potential& part() const {
    return electric_;
  }
  double cyclotron_frequency() const { return frequency_; }  ///< frequency of the turns around the field
  /// v = p - A(q).
  template <class State>
  auto velocity_of(const State& x) const {
    auto v = x.p;
    v[0] += x.q[1] * (0.5 * frequency_);
    v[1] -= x.q[0] * (0.5 * frequency_);
    return v;
  }
  /// Makes p = v + A(q).
  template <class State>
  void set_velocity(State& x, const auto& v) const {
    x.p = v;
    x.p[0] -= x.q[1] * (0.5 * frequency_);
    x.p[1] += x.q[0] * (0.5 * frequency_);
  }
  /// The state at q with velocity v.
  phase_point<double, 3> at(const vector<double, 3>& q, const vector<double, 3>& v) const {
    phase_point<double, 3> x{q, v};
    set_velocity(x, v);
    return x;
  }
  /// H, which the motion conserves.
  template <class T>
  T energy_of(const phase_point<T, 3>& x) const {
    const auto v = velocity_of(x);
    return (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * 0.5 + electric_.potential(x.q);
  }
  std::string description() const {
    return sentence("charged_particle({}, cyclotron_frequency={})", describe(electric_), frequency_);
  }

 private:
  Potential electric_;
  double frequency_;
};

/// The quadrupole of a Penning trap with an octupole, both harmonic functions:
///   V = omega_z^2/2 (z^2 - rho^2/2) + octupole (z^4 - 3 z^2 rho^2 + 3 rho^4/8),  rho^2 = x^2 + y^2.
/// Along the field it traps, across it only the magnetic field does, where cyclotron_frequency^2 > 2
/// omega_z^2 and the amplitudes are small. Source: [brown_gabrielse_1986].
class penning_potential {
 public:
  static constexpr int dimension = 3;

  /// Throws std::invalid_argument unless omega_z is positive and both are finite.
  explicit penning_potential(double omega_z, double octupole = 0.0) : omega_z_(omega_z), octupole_(octupole) {
    if (!(omega_z > 0.0) || !std::isfinite(omega_z) || !std::isfinite(octupole)) {
      throw std::invalid_argument(
          sentence("penning_potential: omega_z must be positive and both finite, got {} and the octupole {}",
                   omega_z, octupole));
    }
  }

  template <class T>
  T potential(const vector<T, 3>& q) const {
    const T rho = q[0] * q[0] + q[1] * q[1];
    const T z = q[2] * q[2];
    return (z - rho * 0.5) * (0.5 * omega_z_ * omega_z_) +
           (z * z - z * rho * 3.0 + rho * rho * 0.375) * octupole_;
  }
  template <class T>
  void force(const vector<T, 3>& q, vector<T, 3>& f) const {
    const double k = omega_z_ * omega_z_;
    const T rho = q[0] * q[0] + q[1] * q[1];
    const T z = q[2] * q[2];
    const T across = T(0.5 * k) + (z * 6.0 - rho * 1.5) * octupole_;
    f[0] = q[0] * across;
    f[1] = q[1] * across;
    f[2] = q[2] * (T(-k) - (z * 4.0 - rho * 6.0) * octupole_);
  }
  std::string description() const {
    return sentence("penning_potential(omega_z={}, octupole={})", omega_z_, octupole_);
  }

 private:
  double omega_z_;
  double octupole_;
};

/// A Penning trap: charged_particle(penning_potential(omega_z), cyclotron_frequency).
using penning_trap = charged_particle<penning_potential>;

// Motion in a uniform magnetic field, exactly and by Boris' steps.

/// A particle in a uniform magnetic field, see systems/charged_particle.hpp: velocities and canonical
/// momenta.
template <class S>
concept HasMagneticField = System<S> && S::dimension == 3 && requires(const S& s) {
  { s.cyclotron_frequency() } -> std::convertible_to<double>;
};

/// m: the exact flow of |v|^2/2 with v = p - A(q): v turns around the field, and q goes along the helix.
/// Symplectic in q and p. With -p it would turn the other way, so that R(q, p) = (q, -p) does not reverse it.
struct cyclotron_flow : exact_flow<'m'> {
  static constexpr bool reversible = false;  ///< false: the field would have to be reversed with p

  template <System S, Scalar T>
  static constexpr bool serves = HasMagneticField<S>;

  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto&) {
    using std::cos;
    using std::sin;
    const double omega = system.cyclotron_frequency();
    const C c = cos(t * omega);
    const C s = sin(t * omega);
    const C half = sin(t * (0.5 * omega));
    const C along = s * (1.0 / omega);
    const C across = half * half * (2.0 / omega);  // (1 - cos)/omega without cancellation
    auto v = system.velocity_of(x);
    x.q[0] += v[0] * along + v[1] * across;
    x.q[1] += v[1] * along - v[0] * across;
    x.q[2] += v[2] * t;
    const auto first = v[0];
    v[0] = first * c + v[1] * s;
    v[1] = v[1] * c - first * s;
    system.set_velocity(x, v);
  }
};

/// v: q goes straight on with v, which stays. Keeps volume, but is not symplectic: p = v + A(q) changes with
/// q.
struct velocity_drift : exact_flow<'v'> {
  static constexpr bool symplectic = false;
  static constexpr bool reversible = false;  ///< false: R(q, p) = (q, -p) is no reversal,
                                             ///< as v is not p

  template <System S, Scalar T>
  static constexpr bool serves = HasMagneticField<S>;

  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto&) {
    const auto v = system.velocity_of(x);
    for (Eigen::Index i = 0; i < 3; ++i) x.q[i] += v[i] * t;
    system.set_velocity(x, v);
  }
};

/// w: v turns around the field by Boris' angle 2 arctan(omega t/2), and q stays: four products and no sine.
/// Keeps volume and |v|, but is not symplectic. Source: [boris_1970].
struct boris_turn : exact_flow<'w'> {
  static constexpr bool moves_q = false;
  static constexpr bool additive = false;
  static constexpr bool symplectic = false;
  static constexpr bool reversible = false;  ///< false: the field would have to be reversed with p

  template <System S, Scalar T>
  static constexpr bool serves = HasMagneticField<S>;

  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto&) {
    const C half = t * (0.5 * system.cyclotron_frequency());
    const C s = half * 2.0 / (C(1.0) + half * half);
    auto v = system.velocity_of(x);
    const auto first = v[0] + v[1] * half;
    v[1] = v[1] - first * s;
    v[0] = first + v[1] * half;
    system.set_velocity(x, v);
  }
};

// Methods for a charged particle in a uniform magnetic field.

/// Half a step straight on, half an electric kick, Boris' turn, half a kick, half a step straight on. Order
/// 2, one electric force; it keeps volume, but is not symplectic. Source: [boris_1970; qin_and_others_2013].
inline method boris() {
  return {"boris",
          word_of<velocity_drift, kick_of_part<0>, boris_turn, kick_of_part<0>, velocity_drift>(),
          {0.5, 0.5, 1.0, 0.5, 0.5},
          {2, true, false}};
}

/// Half a helix, an electric kick, half a helix: symplectic, of order 2, one electric force, and exact
/// without an electric field.
inline method cyclotron_verlet() {
  return {"cyclotron_verlet",
          word_of<cyclotron_flow, kick_of_part<0>, cyclotron_flow>(),
          {0.5, 1.0, 0.5},
          {2, true, false}};
}

}  // namespace examples
