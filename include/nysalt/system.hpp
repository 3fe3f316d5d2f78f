// SPDX-License-Identifier: BSL-1.0
// What a Hamiltonian H(q, p) = K(p) + V(q) must offer, and what the library deduces from it.
//
// A user writes `dimension` and one of
//   template <class T> T potential(const vector<T, N>& q) const;                      force by autodiff
//   template <class T> void force(const vector<T, N>& q, vector<T, N>& f) const;      f = -grad V
//   void force(const vector<double, N>& q, vector<double, N>& f) const;               a black box
// and, if wanted,
//   void force_derivative(q, v, g) const, all vector<double, N>;   g = f'(q) v, else central differences
//   double inverse_mass(Eigen::Index i) const;                      K = sum p_i^2 / (2 m_i), else m_i = 1
//   template <class T> T kinetic_energy(const vector<T, N>& p) const;                 any other K(p)
//   template <class T> void velocity(const vector<T, N>& p, vector<T, N>& v) const;   v = grad K
//   normal_modes modes() const;  std::vector<frequency_band> frequency_bands() const;
//   std::string description() const;
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <string>
#include <typeinfo>
#include <vector>

#include "nysalt/phase_point.hpp"
#include "nysalt/scalars/dual.hpp"

namespace nysalt {

/// Orthonormal modes of the quadratic part: column k of `basis` in mass-weighted coordinates M^{1/2} q,
/// with angular frequency `frequencies[k]` (0: the quadratic part does not act on it).
struct normal_modes {
  Eigen::MatrixXd basis;
  Eigen::VectorXd frequencies;
};

/// Angular frequencies low..high that the linearised motion has.
struct frequency_band {
  double low;
  double high;
};

template <class S>
concept System = std::copyable<S> &&
    (S::dimension > 0 || (S::dimension == Eigen::Dynamic && requires(const S& s) {
       { s.size() } -> std::convertible_to<Eigen::Index>;
     }));

template <class S, class T>
concept HasPotential = requires(const S& s, const vector<T, S::dimension>& q) {
  { s.potential(q) } -> std::same_as<T>;
};
template <class S, class T>
concept HasForce = requires(const S& s, const vector<T, S::dimension>& q, vector<T, S::dimension>& f) {
  s.force(q, f);
};
template <class S>
concept HasForceDerivative = requires(const S& s, const vector<double, S::dimension>& q,
                                      const vector<double, S::dimension>& v,
                                      vector<double, S::dimension>& g) {
  s.force_derivative(q, v, g);
};
template <class S>
concept HasInverseMass = requires(const S& s, Eigen::Index i) {
  { s.inverse_mass(i) } -> std::same_as<double>;
};
template <class S, class T>
concept HasKineticEnergy = requires(const S& s, const vector<T, S::dimension>& p) {
  { s.kinetic_energy(p) } -> std::same_as<T>;
};
template <class S, class T>
concept HasVelocity = requires(const S& s, const vector<T, S::dimension>& p, vector<T, S::dimension>& v) {
  s.velocity(p, v);
};
template <class S>
concept HasModes = requires(const S& s) {
  { s.modes() } -> std::same_as<normal_modes>;
};
template <class S>
concept HasFrequencyBands = requires(const S& s) {
  { s.frequency_bands() } -> std::same_as<std::vector<frequency_band>>;
};

/// A force that is known for double only; its derivatives come from `force_derivative` or differences.
template <class S>
concept BlackBoxForce = HasForce<S, double> && !HasForce<S, dual<double, 1>>;

namespace detail {
template <class T>
inline constexpr bool is_dual_of_double = false;
template <int N>
inline constexpr bool is_dual_of_double<dual<double, N>> = true;

/// Directions that one sweep of automatic differentiation carries: all of a small fixed dimension at once.
template <int N>
inline constexpr int sweep = (N == Eigen::Dynamic || N > 16) ? 1 : N;
}  // namespace detail

/// A system whose force can be evaluated over the scalar T.
template <class S, class T>
concept SystemOver = System<S> &&(HasForce<S, T> || HasPotential<S, dual<T, detail::sweep<S::dimension>>> ||
                                  (BlackBoxForce<S> && detail::is_dual_of_double<T>));

/// H = K(p) + V(q): kicks and drifts are exact.
template <class S>
concept SeparableSystem = SystemOver<S, double> && SystemOver<S, dual<double, 1>>;

/// K = p M^-1 p / 2 with a diagonal M: what methods of Runge-Kutta-Nystrom type need for their order.
template <class S>
concept NystromSystem = SeparableSystem<S> && !HasKineticEnergy<S, double> && !HasVelocity<S, double>;

/// H can be evaluated.
template <class S, class T = double>
concept HasEnergy = HasPotential<S, T> &&(NystromSystem<S> || HasKineticEnergy<S, T>);

/// Number of degrees of freedom.
template <System S>
Eigen::Index size(const S& system) {
  if constexpr (S::dimension == Eigen::Dynamic) {
    return system.size();
  } else {
    return S::dimension;
  }
}

/// A vector of the system's dimension.
template <Scalar T, System S>
vector<T, S::dimension> make_vector(const S& system) {
  return vector<T, S::dimension>(size(system));
}

/// result = sign * grad function at x, by automatic differentiation of function(vector) -> scalar.
/// Cost: 1 evaluation over dual<T, N> for small fixed N, else N evaluations over dual<T, 1>.
template <class T, int N>
void gradient(const auto& function, const vector<T, N>& x, double sign, vector<T, N>& result) {
  constexpr int width = detail::sweep<N>;
  using D = dual<T, width>;
  vector<D, N> lifted(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) lifted[i] = D(x[i]);
  for (Eigen::Index first = 0; first < x.size(); first += width) {
    for (int k = 0; k < width; ++k) lifted[first + k] = D::variable(x[first + k], k);
    const D value = function(lifted);
    for (int k = 0; k < width; ++k) {
      result[first + k] = sign * value.derivative[static_cast<std::size_t>(k)];
      lifted[first + k] = D(x[first + k]);
    }
  }
}

/// g = f'(q) v of a black-box force: the system's own, or central differences with an error of order
/// eps^(2/3) relative to |f|/|q| (two evaluations).
template <System S>
  requires HasForce<S, double>
void directional_derivative(const S& system, const vector<double, S::dimension>& q,
                            const vector<double, S::dimension>& v, vector<double, S::dimension>& g) {
  if constexpr (HasForceDerivative<S>) {
    system.force_derivative(q, v, g);
  } else {
    double length = 0.0;
    double scale = 1.0;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      length = std::max(length, std::abs(v[i]));
      scale = std::max(scale, std::abs(q[i]));
    }
    for (Eigen::Index i = 0; i < q.size(); ++i) g[i] = 0.0;
    if (length == 0.0) return;
    // The optimal step of a central difference balances eps/s against s^2.
    const double s = std::cbrt(std::numeric_limits<double>::epsilon()) * scale / length;
    auto ahead = q;
    auto behind = q;
    auto f_behind = q;
    for (Eigen::Index i = 0; i < q.size(); ++i) ahead[i] += s * v[i];
    for (Eigen::Index i = 0; i < q.size(); ++i) behind[i] -= s * v[i];
    system.force(ahead, g);
    system.force(behind, f_behind);
    for (Eigen::Index i = 0; i < q.size(); ++i) g[i] = (g[i] - f_behind[i]) / (2.0 * s);
  }
}

/// f = -grad V(q) over any scalar that the system can serve.
template <class T, SystemOver<T> S>
void force(const S& system, const vector<T, S::dimension>& q, vector<T, S::dimension>& f) {
  if constexpr (HasForce<S, T>) {
    system.force(q, f);
  } else if constexpr (HasPotential<S, dual<T, detail::sweep<S::dimension>>>) {
    gradient<T, S::dimension>([&](const auto& x) { return system.potential(x); }, q, -1.0, f);
  } else {  // a black box over dual<double, N>: f(q + e v) = f(q) + e f'(q) v
    auto value = make_vector<double>(system);
    auto direction = value;
    auto result = value;
    for (Eigen::Index i = 0; i < q.size(); ++i) value[i] = q[i].value;
    system.force(value, result);
    for (Eigen::Index i = 0; i < q.size(); ++i) f[i].value = result[i];
    for (std::size_t k = 0; k < T::derivatives; ++k) {
      for (Eigen::Index i = 0; i < q.size(); ++i) direction[i] = q[i].derivative[k];
      directional_derivative(system, value, direction, result);
      for (Eigen::Index i = 0; i < q.size(); ++i) f[i].derivative[k] = result[i];
    }
  }
}

/// How derivatives of the force come about, for reports.
template <SeparableSystem S>
constexpr const char* derivative_source() {
  if constexpr (!BlackBoxForce<S>) return "automatic differentiation";
  if constexpr (HasForceDerivative<S>) return "the system's directional derivative";
  return "central differences of the force";
}

/// v = grad K(p): p_i / m_i, or the system's own, or by autodiff from its kinetic energy.
template <class T, System S>
void velocity(const S& system, const vector<T, S::dimension>& p, vector<T, S::dimension>& v) {
  if constexpr (HasVelocity<S, T>) {
    system.velocity(p, v);
  } else if constexpr (HasKineticEnergy<S, double>) {
    gradient<T, S::dimension>([&](const auto& y) { return system.kinetic_energy(y); }, p, 1.0, v);
  } else if constexpr (HasInverseMass<S>) {
    for (Eigen::Index i = 0; i < p.size(); ++i) v[i] = p[i] * system.inverse_mass(i);
  } else {
    for (Eigen::Index i = 0; i < p.size(); ++i) v[i] = p[i];
  }
}

template <class T, HasEnergy<T> S>
T kinetic_energy(const S& system, const vector<T, S::dimension>& p) {
  if constexpr (HasKineticEnergy<S, T>) {
    return system.kinetic_energy(p);
  } else {
    T sum(0.0);
    for (Eigen::Index i = 0; i < p.size(); ++i) {
      if constexpr (HasInverseMass<S>) {
        sum += p[i] * p[i] * system.inverse_mass(i);
      } else {
        sum += p[i] * p[i];
      }
    }
    return sum * 0.5;
  }
}

/// H(q, p) = K(p) + V(q).
template <class T, HasEnergy<T> S>
T energy(const S& system, const phase_point<T, S::dimension>& x) {
  return kinetic_energy<T>(system, x.p) + system.potential(x.q);
}

/// What a learned method remembers of its system, so that it can refuse another one.
template <System S>
std::string describe(const S& system) {
  if constexpr (requires {
                  { system.description() } -> std::convertible_to<std::string>;
                }) {
    return system.description();
  } else {
    std::string name = typeid(S).name();  // in steps: g++ 12 warns wrongly about a chain of +
    name += " with ";
    name += std::to_string(size(system));
    name += " degrees of freedom";
    return name;
  }
}

}  // namespace nysalt
