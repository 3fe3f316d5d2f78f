// SPDX-License-Identifier: BSL-1.0
// f'(q) v by dual numbers, by the system's own word, and by differences; and its own derivatives.
#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/systems/counted.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/lennard_jones_cluster.hpp"
#include "nysalt/systems/pendulum.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <field F, Scalar T, System S>
vector<T, S::dimension> along(const S& system, const vector<T, S::dimension>& q,
                              const vector<T, S::dimension>& v) {
  lifted_room<T, S::dimension> room(q.size());
  auto g = make_vector<T>(system);
  force_along<F, T>(system, q, v, g, room);
  return g;
}

/// One that gives f'(q) v over any scalar, and says so by a factor.
struct by_itself : potential_only {
  template <class T>
  void force_derivative(const vector<T, 2>&, const vector<T, 2>& v, vector<T, 2>& g) const {
    for (Eigen::Index i = 0; i < 2; ++i) g[i] = v[i] * 7.0;
  }
};

/// f = -sin q: f'(q) v, and its derivative along dq and dv, -cos(q) dv + sin(q) dq v.
template <System S>
void check_pendulum(const S& system, double tolerance, double tolerance_of_slope) {
  using D = dual<double, 2>;
  draws random;
  for (int n = 0; n < 10; ++n) {
    const double q = random.uniform(-1.0, 1.0);
    const double v = random.uniform(-1.0, 1.0);
    const vector<double, 1> g =
        along<field::whole, double>(system, vector<double, 1>(q), vector<double, 1>(v));
    BOOST_TEST(std::abs(g[0] + std::cos(q) * v) <= tolerance);
    D lifted_q(q);
    D lifted_v(v);
    lifted_q.derivative = {0.3, 0.0};
    lifted_v.derivative = {0.2, -1.1};
    const auto lifted = along<field::whole, D>(system, vector<D, 1>(lifted_q), vector<D, 1>(lifted_v))[0];
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", q = " << q << ", v = " << v) {
      BOOST_TEST(std::abs(lifted.value + std::cos(q) * v) <= tolerance);
      const double first = -std::cos(q) * 0.2 + std::sin(q) * 0.3 * v;
      BOOST_TEST(std::abs(lifted.derivative[0] - first) <= tolerance_of_slope);
      BOOST_TEST(std::abs(lifted.derivative[1] - std::cos(q) * 1.1) <= tolerance_of_slope);
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(by_dual_numbers_it_is_the_hessians) {
  draws random;
  const auto check = [&](const auto& system) {
    const auto [q, v] = random.state(system, 1.0);
    const Eigen::VectorXd expected = -test::hessian(system, q) * v;
    // Some ten products of numbers below 4 a coordinate.
    const Eigen::VectorXd found = along<field::whole, double>(system, q, v);
    BOOST_TEST((found - expected).norm() <= 40.0 * static_cast<double>(q.size()) * eps);
    BOOST_TEST(expected.norm() > 1e-3);
  };
  check(potential_only());
  check(dynamic_potential());
  check(two_masses());
  check_pendulum(pendulum(), 4.0 * eps, 8.0 * eps);
}

BOOST_AUTO_TEST_CASE(a_derivative_of_ones_own_goes_first) {
  const vector<double, 2> q(0.3, 0.2);
  const vector<double, 2> v(1.0, -2.0);
  BOOST_TEST((along<field::whole, double>(by_itself(), q, v) == 7.0 * v));
  BOOST_TEST((along<field::whole, double>(potential_only(), q, v) != 7.0 * v));
  using D = dual<double, 1>;
  const vector<D, 2> lifted(D::variable(1.0, 0), D(-2.0));
  const auto found = along<field::whole, D>(by_itself(), q.cast<D>(), lifted);
  BOOST_TEST(found[0].derivative[0] == 7.0);
  // Where it is known over double alone, its derivatives are differences of it: s^2/6, twice, and eps/s.
  constexpr double s = detail::part_of_displacement;
  check_pendulum(black_box_with_derivative(), 4.0 * eps, 2.0 * s * s / 6.0 + 8.0 * eps / s);
}

BOOST_AUTO_TEST_CASE(of_a_black_box_it_is_a_difference) {
  // s^2/6 and eps/s; and of differences of differences, 10 s along v and along dq, of length 1 and .3, whose
  // cosine terms are (10 s)^2/6 and eps/(100 s^2).
  constexpr double s = detail::part_of_displacement;
  check_pendulum(black_box(), s * s / 6.0 + 4.0 * eps / s,
                 100.0 * s * s / 6.0 * 2.0 + 8.0 * eps / (100.0 * s * s));
  const vector<double, 1> none(0.0);
  BOOST_TEST((along<field::whole, double>(black_box(), vector<double, 1>(0.4), none)[0] == 0.0));
}

namespace {

/// Without the derivative by hand.
template <class S>
struct automatic {
  static constexpr int dimension = S::dimension;
  S system;
  Eigen::Index size() const { return system.size(); }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    system.force(q, f);
  }
};

template <Scalar T, class S>
void check_by_hand(const S& system, const Eigen::VectorXd& q) {
  static_assert(HasForceDerivative<S, T> && !HasForceDerivative<automatic<S>, T>);
  draws random;
  auto at = make_vector<T>(system);
  auto v = at;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    at[i] = T(q[i] + random.uniform(-0.02, 0.02));
    v[i] = T(random.uniform(-1.0, 1.0));
  }
  const auto found = along<field::whole, T>(system, at, v);
  const auto expected = along<field::whole, T>(automatic<S>{system}, at, v);
  double size = 0.0;
  for (Eigen::Index i = 0; i < at.size(); ++i) size = std::max(size, std::abs(lane(expected[i], 0)));
  for (Eigen::Index i = 0; i < at.size(); ++i) {  // sums of some terms that cancel
    BOOST_TEST(std::abs(lane(found[i] - expected[i], 0)) <= 100.0 * eps * size);
  }
  BOOST_TEST(size > 0.1);
}

/// Another force, and by no word of its own another derivative.
struct stronger : fpu_chain<3> {
  using fpu_chain<3>::fpu_chain;
  template <class T>
  void force(const vector<T, 6>& q, vector<T, 6>& f) const {
    fpu_chain<3>::force(q, f);
    for (auto& entry : f) entry = entry * 2.0;
  }
};
static_assert(HasForceDerivative<fpu_chain<3>> && !HasForceDerivative<stronger>);

}  // namespace

BOOST_AUTO_TEST_CASE(derivatives_by_hand_are_those_of_the_force) {
  const auto all = [](const auto& system, const Eigen::VectorXd& q) {
    check_by_hand<double>(system, q);
    check_by_hand<pack<double, 4>>(system, q);
  };
  const Eigen::VectorXd waves = Eigen::VectorXd::LinSpaced(256, 0.0, 40.0).array().sin();
  all(lennard_jones<2, 7>(), cluster_at_rest(lennard_jones<2, 7>()));
  all(lennard_jones<>(3, 13), cluster_at_rest(lennard_jones<>(3, 13)));
  all(fpu_chain<3>(50.0), waves.head(6));
  all(fpu_chain<>(100, 2.0), waves.head(200));
}

BOOST_AUTO_TEST_CASE(a_derivative_that_is_inherited_is_not_that_of_another_force) {
  const stronger twice(50.0);
  const vector<double, 6> q = vector<double, 6>::Constant(0.3);
  const vector<double, 6> v = vector<double, 6>::LinSpaced(0.0, 1.0);
  const vector<double, 6> expected = 2.0 * along<field::whole, double>(fpu_chain<3>(50.0), q, v);
  const vector<double, 6> found = along<field::whole, double>(twice, q, v);
  BOOST_TEST((found - expected).norm() <= 10.0 * eps * expected.norm());
}

BOOST_AUTO_TEST_CASE(of_the_soft_part_it_is_that_of_the_soft_force) {
  const with_quadratic_part split(two_masses(), Eigen::MatrixXd{{1.0, -1.0}, {-1.0, 1.0}});
  draws random;
  const auto [q, v] = random.state(split, 1.0);
  const vector<double, 2> soft = along<field::soft, double>(split, q, v);
  for (Eigen::Index i = 0; i < 2; ++i) {
    BOOST_TEST(std::abs(soft[i] + 3.0 * q[i] * q[i] * v[i]) <= 16.0 * eps);  // of terms that cancel
  }
  BOOST_TEST((along<field::whole, double>(split, q, v) - soft).norm() > 1e-3);
}

BOOST_AUTO_TEST_CASE(it_counts_what_is_called) {
  const auto evaluations = [](const auto& system) {
    using S = std::decay_t<decltype(system)>;
    const counted<S> watched(system);
    auto q = make_vector<double>(system);
    q.setConstant(0.3);
    along<field::whole, double>(watched, q, q);
    return watched.evaluations;
  };
  BOOST_TEST(evaluations(potential_only()) == 1);
  BOOST_TEST(evaluations(dynamic_potential()) == 1);
  BOOST_TEST(evaluations(by_itself()) == 1);
  BOOST_TEST(evaluations(black_box()) == 2);  // a difference
  BOOST_TEST(evaluations(black_box_with_derivative()) == 1);
}
