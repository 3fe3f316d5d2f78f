// SPDX-License-Identifier: BSL-1.0
// Systems that only tests need: one for each way in which a user may write one.
#pragma once

#include <atomic>
#include <cmath>
#include <thread>

#include "nysalt/lanes.hpp"
#include "nysalt/system.hpp"

namespace nysalt::test {

/// A potential and nothing else.
struct potential_only {
  static constexpr int dimension = 2;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    return (q[0] * q[0] + q[1] * q[1]) * 0.5 + q[0] * q[0] * q[1] * q[1];
  }
};

/// The same in any dimension: a ring of quartic wells.
struct dynamic_potential {
  static constexpr int dimension = Eigen::Dynamic;
  Eigen::Index masses = 3;
  Eigen::Index size() const { return masses; }
  template <class T>
  T potential(const vector<T, dimension>& q) const {
    T sum(0.0);
    for (Eigen::Index i = 0; i < masses; ++i) {
      const T elongation = q[(i + 1) % masses] - q[i];
      sum += elongation * elongation * 0.5 + q[i] * q[i] * q[i] * q[i] * 0.25;
    }
    return sum;
  }
};

/// The pendulum's force, for double only.
struct black_box {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = -std::sin(q[0]); }
};

/// The same with f'(q) v.
struct black_box_with_derivative : black_box {
  void force_derivative(const vector<double, 1>& q, const vector<double, 1>& v, vector<double, 1>& g) const {
    g[0] = -std::cos(q[0]) * v[0];
  }
};

/// Two different masses on a nonlinear spring.
struct two_masses {
  static constexpr int dimension = 2;
  double inverse_mass(Eigen::Index i) const { return i == 0 ? 1.0 : 0.25; }
  template <class T>
  T potential(const vector<T, 2>& q) const {
    const T elongation = q[1] - q[0];
    return elongation * elongation * 0.5 + (q[0] * q[0] * q[0] * q[0] + q[1] * q[1] * q[1] * q[1]) * 0.25;
  }
};

/// K = sqrt(1 + p^2), which no method of Runge-Kutta-Nystrom type was made for, in a quartic well.
struct relativistic {
  static constexpr int dimension = 1;
  template <class T>
  T kinetic_energy(const vector<T, 1>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + 1.0);
  }
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * 0.5 + q[0] * q[0] * q[0] * q[0] * 0.25;
  }
};

/// The same with a velocity of its own.
struct relativistic_with_velocity : relativistic {
  template <class T>
  void velocity(const vector<T, 1>& p, vector<T, 1>& v) const {
    using std::sqrt;
    v[0] = p[0] / sqrt(p[0] * p[0] + 1.0);
  }
};

/// Relativistic, and stiff: V = 50 q^2 + 20 q^4.
struct fast_particle {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * 50.0 + q[0] * q[0] * q[0] * q[0] * 20.0;
  }
  template <class T>
  T kinetic_energy(const vector<T, 1>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + 1.0) - 1.0;
  }
};

/// A mistake: the force is 1 % too strong. The laws of systems must find it.
struct wrong_force : potential_only {
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    f[0] = (q[0] + q[0] * q[1] * q[1] * 2.0) * -1.01;
    f[1] = -q[1] - q[0] * q[0] * q[1] * 2.0;
  }
};

/// A mistake: the kick is not that of the force. The laws of systems must find it.
struct wrong_kick : potential_only {
  template <class T, class C>
  void kick(const vector<T, 2>& q, vector<T, 2>& p, const C& c) const {
    p[0] -= (q[0] + q[0] * q[1] * q[1] * 2.0) * c;
    p[1] -= (q[1] + q[0] * q[0] * q[1] * 2.1) * c;
  }
};

/// A system whose own kick is not to be found.
template <System S>
struct without_kick : S {
  explicit without_kick(const S& system) : S(system) {}
  void kick() const = delete;
};

/// The same system, stepped in another number of lanes.
template <class S, int L>
struct in_lanes : S {
  static constexpr int lanes = L;
  explicit in_lanes(const S& system) : S(system) {}
};

/// A black box whose force and potential have memory: an oscillator that counts how often two threads met in
/// one object. A copy begins anew; each Test has a count of its own.
template <class Test>
struct with_memory {
  static constexpr int dimension = 1;
  static inline std::atomic<int> meetings = 0;
  mutable std::atomic<int> inside = 0;

  with_memory() = default;
  with_memory(const with_memory&) {}
  with_memory& operator=(const with_memory&) { return *this; }
  ~with_memory() = default;

  void force(const vector<double, 1>& q, vector<double, 1>& f) const {
    visit();
    f[0] = -q[0];
  }
  double potential(const vector<double, 1>& q) const {
    visit();
    return 0.5 * q[0] * q[0];
  }

 private:
  void visit() const {
    thread_local int visits = 0;
    if (++inside != 1) ++meetings;
    if (++visits % 17 == 0) std::this_thread::yield();  // a prime: no regular order of calls evades it
    --inside;
  }
};

}  // namespace nysalt::test
