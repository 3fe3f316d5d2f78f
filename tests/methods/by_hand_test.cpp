// SPDX-License-Identifier: BSL-1.0
// Steps with gradient kicks and with rotations are those that formulas give, written out.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>

#include "../support/rounding.hpp"
#include "nysalt/derivatives/jacobian.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/pendulum.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double h = 0.3;

/// V = -cos q: f = -sin q, f' f = cos q sin q.
double gradient_kick_of_pendulum(double q, double b, double c) {
  return -b * h * std::sin(q) + 2.0 * c * h * h * h * std::cos(q) * std::sin(q);
}

phase_point<double, 1> pendulum_at(double q, double p) {
  return {vector<double, 1>(q), vector<double, 1>(p)};
}

// Some ten operations on numbers of size 1, in another order.
constexpr double rounding = 10.0 * eps;

/// Nothing of it is soft.
struct two_oscillators : henon_heiles {
  template <class T>
  void soft_force(const vector<T, 2>&, vector<T, 2>& f) const {
    f[0] = f[1] = T(0.0);
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(takahashi_and_imadas_step_on_a_pendulum) {
  auto x = pendulum_at(0.7, -0.4);
  const pendulum system;
  step_map(system, takahashi_imada(), h)(x);
  double q = 0.7;
  double p = -0.4;
  q += 0.5 * h * p;
  p += gradient_kick_of_pendulum(q, 1.0, 1.0 / 24.0);
  q += 0.5 * h * p;
  BOOST_TEST(distance(x, pendulum_at(q, p)) <= rounding);
  BOOST_TEST(std::abs(h * h * h * std::cos(q) * std::sin(q) / 12.0) > 1e6 * rounding);  // it matters
}

BOOST_AUTO_TEST_CASE(chins_step_on_a_pendulum) {
  auto x = pendulum_at(0.7, -0.4);
  const pendulum system;
  step_map(system, chin4a(), h)(x);
  double q = 0.7;
  double p = -0.4;
  p -= h / 6.0 * std::sin(q);
  q += 0.5 * h * p;
  p += gradient_kick_of_pendulum(q, 2.0 / 3.0, 1.0 / 72.0);
  q += 0.5 * h * p;
  p -= h / 6.0 * std::sin(q);
  BOOST_TEST(distance(x, pendulum_at(q, p)) <= rounding);
}

// V = |q|^2/2 + q1^2 q2 - q2^3/3: two oscillators of frequency 1, and what is soft.
BOOST_AUTO_TEST_CASE(the_impulse_methods_step_on_a_galaxy) {
  phase_point<double, 2> x{{0.2, -0.1}, {0.3, 0.15}};
  auto y = x;
  const henon_heiles system;
  step_map(system, impulse(), h)(x);
  const auto half_kick = [&] {
    y.p[0] -= 0.5 * h * 2.0 * y.q[0] * y.q[1];
    y.p[1] -= 0.5 * h * (y.q[0] * y.q[0] - y.q[1] * y.q[1]);
  };
  half_kick();
  y = {std::cos(h) * y.q + std::sin(h) * y.p, std::cos(h) * y.p - std::sin(h) * y.q};
  half_kick();
  BOOST_TEST(distance(x, y) <= rounding);
}

// Without a soft part the impulse method is exact at any step.
BOOST_AUTO_TEST_CASE(rotations_are_exact) {
  phase_point<double, 2> x{{0.2, -0.1}, {0.3, 0.15}};
  const auto start = x;
  const two_oscillators system;
  step_map(system, impulse(), 2.0 * std::numbers::pi)(x);
  BOOST_TEST(distance(x, start) <= rounding);
  step_map(system, impulse(), std::numbers::pi)(x);
  BOOST_TEST(distance(x, start) > 0.1);
}
