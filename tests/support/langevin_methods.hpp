// SPDX-License-Identifier: BSL-1.0
// The words with letters O that the linear tests go through, and one step of each as a matrix and a
// covariance.
#pragma once

#include <vector>

#include "langevin_linear.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/thermostatted.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/in_bath.hpp"

namespace nysalt::test {

/// Two stages in a bath, at a member that is near the optimum and not quite Verlet.
template <placement P>
struct two_stages : member<thermostatted_family<nystrom, P>> {
  two_stages() : member<thermostatted_family<nystrom, P>>({0.5, 0.41}) {}
};
template <placement P>
struct bathed_verlet : thermostatted_method<P, verlet> {
  bathed_verlet() : thermostatted_method<P, verlet>(verlet()) {}
};

/// As data, so that what follows is compiled once. Verlet in a symmetric placement is obabo, and with O in
/// the middle baoab.
inline std::vector<tabulated> langevin_methods() {
  return {tabulated(baoab()),
          tabulated(obabo()),
          tabulated(aboba()),
          tabulated(baoab_2x()),
          tabulated(two_stages<placement::end>()),
          tabulated(two_stages<placement::symmetric>()),
          tabulated(two_stages<placement::middle>()),
          tabulated(bathed_verlet<placement::end>())};
}

using bathed_oscillator = in_bath<harmonic_oscillator>;

inline bathed_oscillator bathed_system(const damped_oscillator& x) {
  return {harmonic_oscillator(x.omega), bath::of_sigma(x.gamma, x.sigma)};
}
inline std::vector<spelled> spell(const tabulated& method) {
  return spell(method.letters().letters(), method.coefficients());
}

inline phase_point<double, 1> point(double q, double p) {
  return {vector<double, 1>(q), vector<double, 1>(p)};
}
inline Eigen::Vector2d coordinates_of(const phase_point<double, 1>& x) { return {x.q[0], x.p[0]}; }

/// The number 1 for one letter O of a step, 0 for the others.
struct one_at {
  static constexpr bool is_memoryless = false;
  int flow;
  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    xi.fill(T(at.flow == flow ? 1.0 : 0.0));
  }
};

/// A step of the library's as it is: what it makes of unit states and of unit numbers, as it is linear.
inline gaussian_step<2> library_step(const damped_oscillator& x, const tabulated& method, double h) {
  const auto system = bathed_system(x);
  gaussian_step<2> result;
  const auto stepped = [&](phase_point<double, 1> state, int flow) {
    make_stepper(system, method, h, one_at{flow}).step(state);
    return coordinates_of(state);
  };
  result.map << stepped(point(1.0, 0.0), -1), stepped(point(0.0, 1.0), -1);
  for (int flow = 0; flow < method.letters().stochastic_letters; ++flow) {
    const Eigen::Vector2d response = stepped(point(0.0, 0.0), flow);
    result.covariance += response * response.transpose();
  }
  return result;
}

}  // namespace nysalt::test
