// SPDX-License-Identifier: BSL-1.0
// Systems: what a user writes, and what follows from it.
#pragma once

#include <cxxabi.h>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <vector>

#include "nysalt/phase_point.hpp"
#include "nysalt/scalars/dual.hpp"

namespace nysalt::detail {

/// With the namespaces that have a name.
inline std::string name_of_type(const std::type_info& type) {
  int failure = 0;
  const std::unique_ptr<char, void (*)(void*)> readable(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &failure), std::free);
  std::string name = readable ? readable.get() : type.name();
  constexpr std::string_view unnamed = "(anonymous namespace)::";
  for (auto at = name.find(unnamed); at != std::string::npos; at = name.find(unnamed)) {
    name.erase(at, unnamed.size());
  }
  return name;
}

}  // namespace nysalt::detail

// What a Hamiltonian H(q, p) = K(p) + V(q) must offer, and what the library deduces from it.
//
// A user writes `dimension` and one of
//   template <class T> T potential(const vector<T, N>& q) const;                      force by autodiff
//   template <class T> void force(const vector<T, N>& q, vector<T, N>& f) const;      f = -grad V
//   void force(const vector<double, N>& q, vector<double, N>& f) const;               a black box
// and, if wanted,
//   void force_derivative(q, v, g) const;                          g = f'(q) v, over double or any scalar
//                                          (else by dual numbers, of a black box by central differences)
//   template <class T, class C> void kick(const vector<T, N>& q, vector<T, N>& p, const C& c) const;
//                                          p += c force(q) without storing the force, each p[i] += f[i] * c;
//                                          written in the class of the force, or below
//   double inverse_mass(Eigen::Index i) const;                      K = sum p_i^2 / (2 m_i), else m_i = 1
//   template <class T> T kinetic_energy(const vector<T, N>& p) const;                 any other K(p)
//   template <class T> void velocity(const vector<T, N>& p, vector<T, N>& v) const;   v = grad K
//   static constexpr int lanes = 1;                                 most trajectories side by side
//
// A template is compiled for double, for dual numbers and for packs, which are many trajectories side by
// side: it calls functions unqualified (sin(x) after `using std::sin`), loops over elements, and writes
// select(condition, a, b) where trajectories may differ; with lanes = 1 it is left in peace by packs.
//   normal_modes modes() const;  std::vector<frequency_band> frequency_bands() const;
//   template <class T> void soft_force(const vector<T, N>& q, vector<T, N>& f) const;
//                                          the force of V less q K q/2, which modes() diagonalises
//   double force_cost() const;             what a force costs, if not one a coordinate
//   std::string description() const;  std::string kind() const;          the description without the size

namespace nysalt {

/// Orthonormal modes of the quadratic part: column k of `basis` in mass-weighted coordinates M^{1/2} q,
/// with angular frequency `frequencies[k]` (0: the quadratic part does not act on it).
struct normal_modes {
  /// An entry of a basis of modes that is not zero.
  struct entry {
    Eigen::Index coordinate;  ///< row
    Eigen::Index mode;        ///< column
    double value;             ///< matrix entry in mass-weighted coordinates
  };

  Eigen::MatrixXd basis;        ///< N x N, orthogonal; 0 x 0 where `entries` hold the basis
  Eigen::VectorXd frequencies;  ///< N frequencies, none negative
  /// Non-zero entries of the basis, row by row, where modes are sums of a few of many coordinates.
  std::vector<entry> entries{};
};

namespace detail {

/// Above this number of coordinates the bundled systems give no full N x N basis: 8 MB.
inline constexpr Eigen::Index most_for_full_basis = 1000;

}  // namespace detail

/// Angular frequencies, low to high, that the linearised motion has.
struct frequency_band {
  double low;   ///< lower end, not negative
  double high;  ///< upper end
};

/// The upper end of the highest of these bands; 0 where there is none.
inline double highest_frequency(const std::vector<frequency_band>& bands) {
  double highest = 0.0;
  for (const auto& band : bands) highest = std::max(highest, band.high);
  return highest;
}

/// A system that can be stepped: copyable, with `static constexpr int dimension`, positive, or
/// Eigen::Dynamic and a size().
// The dimension is asked for first: systems convert to a model, so that whether a class that is made from a
// model can be copied depends on whether the class is a system.
template <class S>
concept System = (S::dimension > 0 || (S::dimension == Eigen::Dynamic && requires(const S& s) {
                    { s.size() } -> std::convertible_to<Eigen::Index>;
                  })) && std::copyable<S>;

/// A system whose members are known at run time: see nysalt/model.hpp.
template <class S>
concept ErasedSystem = System<S> && requires { requires S::is_erased; };

/// V(q) can be evaluated over T.
template <class S, class T>
concept HasPotential = requires(const S& s, const vector<T, S::dimension>& q) {
  { s.potential(q) } -> std::same_as<T>;
};
/// The system has a force(q, f) of its own over T, f = -grad V(q).
template <class S, class T>
concept HasForce =
    requires(const S& s, const vector<T, S::dimension>& q, vector<T, S::dimension>& f) { s.force(q, f); };

namespace detail {
/// The system whose members a user wrote: of a wrapper of the library, which has each member only where the
/// wrapped system has it, that system.
template <class S>
struct written_system : std::type_identity<S> {};

/// The class in which a member function is written.
template <class M>
struct written_in;
template <class R, class X, class... A>
struct written_in<R (X::*)(A...) const> : std::type_identity<X> {};
template <class R, class X, class... A>
struct written_in<R (X::*)(A...) const noexcept> : std::type_identity<X> {};

/// The class that declares the force, or the potential that it comes from; void where that is not known.
template <class S, class T>
consteval auto origin_of_force() {
  using V = vector<T, S::dimension>;
  if constexpr (requires { written_in<decltype(&S::template force<T>)>(); }) {
    return written_in<decltype(&S::template force<T>)>();
  } else if constexpr (requires { written_in<decltype(&S::template force<V, V>)>(); }) {
    return written_in<decltype(&S::template force<V, V>)>();
  } else if constexpr (requires { written_in<decltype(&S::force)>(); }) {
    return written_in<decltype(&S::force)>();
  } else if constexpr (!HasForce<S, T> && requires { written_in<decltype(&S::template potential<T>)>(); }) {
    return written_in<decltype(&S::template potential<T>)>();
  } else {
    return std::type_identity<void>();
  }
}

/// A class that derives from a system and writes another force inherits a kick that is not of that force: a
/// kick counts only if it is written where the force is, or further down.
template <class S, class T, class C>
concept KickOfTheForce = std::is_base_of_v<typename decltype(origin_of_force<S, T>())::type,
                                           typename written_in<decltype(&S::template kick<T, C>)>::type>;

/// Nor is a derivative that is inherited beside another force that force's; where that is not known it
/// counts.
template <class S, class T>
consteval bool derivative_is_of_the_force() {
  using force = typename decltype(origin_of_force<S, T>())::type;
  if constexpr (std::is_void_v<force>) {
    return true;
  } else if constexpr (requires { written_in<decltype(&S::template force_derivative<T>)>(); }) {
    return std::is_base_of_v<force, typename written_in<decltype(&S::template force_derivative<T>)>::type>;
  } else if constexpr (requires { written_in<decltype(&S::force_derivative)>(); }) {
    return std::is_base_of_v<force, typename written_in<decltype(&S::force_derivative)>::type>;
  } else {
    return true;
  }
}

template <class S, class T>
concept CanDifferentiateForce =
    requires(const S& s, const vector<T, S::dimension>& q, const vector<T, S::dimension>& v,
             vector<T, S::dimension>& g) { s.force_derivative(q, v, g); };

template <class S, class T, class C>
concept CanKick = requires(const S& s, const vector<T, S::dimension>& q, vector<T, S::dimension>& p,
                           const C& c) { s.kick(q, p, c); };
}  // namespace detail

/// The system has a kick of its own over T, p += c force(q), that is written in the class of its force or
/// further down: one that is inherited beside another force does not count.
template <class S, class T, class C = double>
concept HasKick = detail::CanKick<S, T, C> && detail::KickOfTheForce<S, T, C>;
/// The system has a directional derivative of its force over T, g = f'(q) v, that is written in the class of
/// its force or further down, as a kick.
template <class S, class T = double>
concept HasForceDerivative =
    detail::CanDifferentiateForce<S, T> && detail::derivative_is_of_the_force<S, T>();
/// The system has the force of V without its quadratic part.
template <class S, class T = double>
concept HasSoftForce = requires(const S& s, const vector<T, S::dimension>& q, vector<T, S::dimension>& f) {
  { s.soft_force(q, f) };
};
/// The system has masses, by 1/m_i; else each is 1.
template <class S>
concept HasInverseMass = requires(const S& s, Eigen::Index i) {
  { s.inverse_mass(i) } -> std::convertible_to<double>;
};
/// The system has a kinetic energy of its own, K(p) over T.
template <class S, class T>
concept HasKineticEnergy = requires(const S& s, const vector<T, S::dimension>& p) {
  { s.kinetic_energy(p) } -> std::same_as<T>;
};
/// The system has a velocity of its own, v = grad K(p) over T.
template <class S, class T>
concept HasVelocity =
    requires(const S& s, const vector<T, S::dimension>& p, vector<T, S::dimension>& v) { s.velocity(p, v); };
/// The system declares the modes of its quadratic part.
template <class S>
concept HasModes = requires(const S& s) {
  { s.modes() } -> std::same_as<normal_modes>;
};
/// The system declares the angular frequencies of its linearised motion, on which a step must be stable.
template <class S>
concept HasFrequencyBands = requires(const S& s) {
  { s.frequency_bands() } -> std::same_as<std::vector<frequency_band>>;
};

/// The system states what an evaluation of its force costs, in coordinates of a cheap force, some nanoseconds
/// each.
template <class S>
concept HasForceCost = requires(const S& s) {
  { s.force_cost() } -> std::same_as<double>;
};

namespace detail {
template <class T>
inline constexpr bool is_dual_of_double = false;
template <int N>
inline constexpr bool is_dual_of_double<dual<double, N>> = true;

/// Directions that one sweep of automatic differentiation carries: all of a small fixed dimension at once.
template <int N>
inline constexpr int sweep = (N == Eigen::Dynamic || N > 16) ? 1 : N;
}  // namespace detail

/// A force that is known for double only, without a potential that could be differentiated instead; its
/// derivatives come from `force_derivative` or differences.
template <class S>
concept BlackBoxForce = HasForce<S, double> && !HasForce<S, dual<double, 1>> &&
                        !HasPotential<S, dual<dual<double, 1>, detail::sweep<S::dimension>>>;

// clang-format off
/// A system whose force can be evaluated over the scalar T.
template <class S, class T>
concept SystemOver = System<S> && (HasForce<S, T> || HasPotential<S, dual<T, detail::sweep<S::dimension>>> ||
                                   (BlackBoxForce<S> && detail::is_dual_of_double<T>));
// clang-format on

/// H = K(p) + V(q), with a force over double and over dual numbers: kicks and drifts are exact.
template <class S>
concept SeparableSystem = SystemOver<S, double> && SystemOver<S, dual<double, 1>>;

/// K = p M^-1 p / 2, also of systems that need not be separable over double: a model and order_probe, whose K
/// is decided at run time, declare so themselves.
template <class S>
concept HasQuadraticKinetic = System<S> && ((!HasKineticEnergy<S, double> && !HasVelocity<S, double>) ||
                                            requires { requires S::may_have_quadratic_kinetic; });

/// K = p M^-1 p / 2 with a diagonal M: what methods of Runge-Kutta-Nystrom type need for their order.
template <class S>
concept NystromSystem = SeparableSystem<S> && HasQuadraticKinetic<S>;

/// H = H_0 + V_soft with a quadratic H_0 = p M^-1 p/2 + q K q/2 whose flow its modes give, and the rest by
/// its force.
template <class S>
concept HasQuadraticPart = NystromSystem<S> && HasModes<S> && HasSoftForce<S>;

// clang-format off
/// H = K + V can be evaluated over T.
template <class S, class T = double>
concept HasEnergy = HasPotential<S, T> && (HasKineticEnergy<S, T> || NystromSystem<S>);
// clang-format on

namespace detail {

/// A potential from which all else comes by automatic differentiation can contradict nothing.
template <class S>
inline constexpr bool force_may_be_wrong = HasForce<S, double> || detail::CanKick<S, double, double> ||
                                           HasForceDerivative<S> || HasSoftForce<S> || HasVelocity<S, double>;

/// What is known of every system: of a type by the concepts, and of a model at run time.
struct system_facts {
  bool has_energy = false;             ///< over double
  bool has_quadratic_kinetic = false;  ///< K = p M^-1 p / 2
  bool has_unit_mass = true;           ///< no masses are declared
  bool is_black_box = false;           ///< the force is known for double only
  bool is_locked = false;  ///< threads that share it call it one at a time, so that each takes a copy
  int threads = 1;         ///< that share a step of one trajectory where the system allows it
};

template <System S>
inline constexpr system_facts facts_of_type{.has_energy = HasEnergy<S>,
                                            .has_quadratic_kinetic = NystromSystem<S>,
                                            .has_unit_mass = !HasInverseMass<S>,
                                            .is_black_box = BlackBoxForce<S>};

template <System S>
constexpr const system_facts& facts_of(const S& system) {
  if constexpr (ErasedSystem<S>) {
    return system.facts();
  } else {
    return facts_of_type<S>;
  }
}
}  // namespace detail

/// Whether H can be evaluated.
template <System S>
constexpr bool has_energy(const S& system) {
  return detail::facts_of(system).has_energy;
}
/// Whether K = p M^-1 p / 2.
template <System S>
constexpr bool has_quadratic_kinetic(const S& system) {
  return detail::facts_of(system).has_quadratic_kinetic;
}
/// Whether the modes of its quadratic part are declared. A system whose modes take too much room at some
/// sizes says so by a member `bool has_modes() const`.
template <System S>
constexpr bool has_modes(const S& system) {
  if constexpr (HasModes<S> && requires {
                  { system.has_modes() } -> std::same_as<bool>;
                }) {
    return system.has_modes();
  }
  return HasModes<S>;
}
namespace detail {

/// Whether its force is known for double only.
template <System S>
constexpr bool is_black_box(const S& system) {
  return detail::facts_of(system).is_black_box;
}

}  // namespace detail

/// Number of degrees of freedom.
template <System S>
Eigen::Index size(const S& system) {
  if constexpr (S::dimension == Eigen::Dynamic) {
    return system.size();
  } else {
    return S::dimension;
  }
}

/// What an evaluation of the force costs, in coordinates of a cheap force: as stated, else the coordinates,
/// and of a potential that is differentiated coordinate by coordinate four times their square. It bounds the
/// work of trials, and measures nothing.
template <System S>
double force_cost(const S& system) {
  const auto coordinates = static_cast<double>(size(system));
  if constexpr (HasForceCost<S>) {
    return system.force_cost();
  } else if constexpr (requires {
                         { system.base() } -> System;
                       }) {
    return force_cost(system.base());
  } else {
    return HasForce<S, double> ? coordinates : 4.0 * coordinates * coordinates;
  }
}

/// The square root of the mass of coordinate i, as 1/sqrt(1/m_i).
template <System S>
double root_mass(const S& system, Eigen::Index i) {
  if constexpr (HasInverseMass<S>) {
    return 1.0 / std::sqrt(system.inverse_mass(i));
  } else {
    return 1.0;
  }
}

namespace detail {

/// A vector of the system's dimension, its entries not set.
template <Scalar T, System S>
vector<T, S::dimension> make_vector(const S& system) {
  return vector<T, S::dimension>(size(system));
}

}  // namespace detail

/// Description of a system, by which a learned method refuses another system. Without a description a
/// system is known only by the name of its type and its size: let yours name its parameters.
template <System S>
std::string describe(const S& system) {
  if constexpr (requires {
                  { system.description() } -> std::convertible_to<std::string>;
                }) {
    return system.description();
  } else {
    std::string name = detail::name_of_type(typeid(S));  // in steps: g++ 12 warns wrongly about a chain of +
    name += " with ";
    name += std::to_string(size(system));
    name += " degrees of freedom";
    return name;
  }
}

namespace detail {

/// Kind of a system: the description without the size, by a member kind(). A method that was learned
/// for one size may be tried at another, see learning/reach.hpp. Systems without that member have a
/// kind of their own, the description.
template <System S>
std::string kind_of(const S& system) {
  if constexpr (requires {
                  { system.kind() } -> std::convertible_to<std::string>;
                }) {
    return system.kind();
  } else {
    return describe(system);
  }
}

}  // namespace detail

}  // namespace nysalt
