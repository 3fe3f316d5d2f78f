// SPDX-License-Identifier: BSL-1.0
// What an evaluation is: one force, and of a black box each call.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <memory>

#include "nysalt/systems/counted.hpp"

using namespace nysalt;

namespace {

struct black_box {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = -q[0] * q[0]; }
};
struct with_derivative : black_box {
  void force_derivative(const vector<double, 1>& q, const vector<double, 1>& v, vector<double, 1>& g) const {
    g[0] = -2.0 * q[0] * v[0];
  }
};
struct calls_counted {
  static constexpr int dimension = 1;
  std::shared_ptr<std::int64_t> calls = std::make_shared<std::int64_t>(0);
  void force(const vector<double, 1>& q, vector<double, 1>& f) const {
    ++*calls;
    f[0] = -std::sin(q[0]);
  }
};
struct with_potential : black_box {
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * q[0] * (1.0 / 3.0);
  }
};
struct of_potential {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * q[0] * (1.0 / 3.0);
  }
};

template <class T, class S>
std::int64_t evaluations_over(const S& system) {
  const counted<S> watched(system);
  vector<T, 1> q(T(2.0));
  vector<T, 1> f(T(0.0));
  force<T>(watched, q, f);
  return watched.evaluations;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_force_counts_one) {
  BOOST_TEST(evaluations_over<double>(black_box()) == 1);
  BOOST_TEST(evaluations_over<double>(of_potential()) == 1);
  BOOST_TEST((evaluations_over<dual<double, 2>>(of_potential()) == 1));
}

// A difference of two calls for each direction, and two more where its step does not fit.
BOOST_AUTO_TEST_CASE(of_a_black_box_each_call_counts) {
  BOOST_TEST((evaluations_over<dual<double, 1>>(black_box()) == 3));
  BOOST_TEST((evaluations_over<dual<double, 2>>(black_box()) == 5));
  BOOST_TEST((evaluations_over<dual<double, 2>>(with_derivative()) == 3));
  const calls_counted real;
  const counted<calls_counted> watched(real);
  vector<dual<double, 2>, 1> q(dual<double, 2>(2.0));
  q[0].derivative = {1.0, 1e9};  // the second displacement is far too long
  vector<dual<double, 2>, 1> f(dual<double, 2>(0.0));
  force<dual<double, 2>>(watched, q, f);
  BOOST_TEST(watched.evaluations == *real.calls);
  BOOST_TEST(watched.evaluations > 5);
  BOOST_TEST(std::abs(f[0].derivative[1] / (-std::cos(2.0) * 1e9) - 1.0) < 1e-7);
}

BOOST_AUTO_TEST_CASE(a_potential_that_can_be_differentiated_goes_before_differences) {
  static_assert(BlackBoxForce<black_box> && !BlackBoxForce<with_potential>);
  BOOST_TEST((evaluations_over<dual<double, 2>>(with_potential()) == 1));
  BOOST_TEST(derivative_source<with_potential>() == std::string("automatic differentiation"));
  BOOST_TEST(derivative_source<black_box>() == std::string("central differences of the force"));
}
