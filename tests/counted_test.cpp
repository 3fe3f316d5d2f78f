// SPDX-License-Identifier: BSL-1.0
// What an evaluation is: one force, and one more for each direction in which a black box is differentiated.
#include <boost/test/unit_test.hpp>

#include "nysalt/counted.hpp"

using namespace nysalt;

namespace {

struct black_box {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = -q[0] * q[0]; }
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

BOOST_AUTO_TEST_CASE(each_direction_of_a_black_box_counts_one_more) {
  BOOST_TEST((evaluations_over<dual<double, 1>>(black_box()) == 2));
  BOOST_TEST((evaluations_over<dual<double, 2>>(black_box()) == 3));
}

BOOST_AUTO_TEST_CASE(a_potential_that_can_be_differentiated_goes_before_differences) {
  static_assert(BlackBoxForce<black_box> && !BlackBoxForce<with_potential>);
  BOOST_TEST((evaluations_over<dual<double, 2>>(with_potential()) == 1));
  BOOST_TEST(derivative_source<with_potential>() == std::string("automatic differentiation"));
  BOOST_TEST(derivative_source<black_box>() == std::string("central differences of the force"));
}
