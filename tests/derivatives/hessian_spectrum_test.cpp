// SPDX-License-Identifier: BSL-1.0
// The stiffness along states is that of Eigen's eigenvalues.
#include <boost/test/unit_test.hpp>

#include <limits>
#include <vector>

#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/derivatives/hessian_spectrum.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Two atoms in a wide trap with V = r^-12 - 2 r^-6 between them: at r = 1.2 their bond has the curvature
/// -7.4, twice which counts, while the trap is as soft as 0.1.
struct trapped_pair {
  static constexpr int dimension = 2;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    const T r = q[1] - q[0];
    const T third = 1.0 / (r * r * r);
    const T sixth = third * third;
    return sixth * sixth - sixth * 2.0 + (q[0] * q[0] + q[1] * q[1]) * 0.05;
  }
};

struct upside_down {
  static constexpr int dimension = 2;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    return -trapped_pair().potential(q);
  }
};

template <System S>
using states_of = std::vector<phase_point<double, S::dimension>>;

template <System S>
states_of<S> random_states(const S& system, draws& random, double reach, int count) {
  states_of<S> states;
  for (int n = 0; n < count; ++n) states.push_back(random.state(system, reach));
  return states;
}

/// The same by all of the matrix.
template <NystromSystem S>
stiffness_range by_eigenvalues(const S& system, const states_of<S>& states) {
  stiffness_range result;
  for (const auto& state : states) {
    Eigen::MatrixXd a = hessian(system, state.q);
    if constexpr (HasInverseMass<S>) {
      for (Eigen::Index i = 0; i < a.rows(); ++i) {
        a.row(i) *= std::sqrt(system.inverse_mass(i));
        a.col(i) *= std::sqrt(system.inverse_mass(i));
      }
    }
    const Eigen::VectorXd values = symmetric_eigen(a).values;
    result.lowest = std::min(result.lowest, values[0]);
    result.highest = std::max(result.highest, values[a.rows() - 1]);
  }
  return result;
}

/// Bounds that are at most 1 % too wide, each by the rule by which the iteration stops; rounding aside.
template <NystromSystem S>
void check_states(const S& system, const states_of<S>& states) {
  const auto found = hessian_spectrum(system, states);
  const auto exact = by_eigenvalues(system, states);
  const auto coordinates = static_cast<double>(size(system));
  const double largest = std::max(std::abs(exact.lowest), std::abs(exact.highest));
  const double rounding = 100.0 * coordinates * eps * largest;
  BOOST_TEST_CONTEXT(describe(system)) {
    BOOST_TEST(found.highest >= exact.highest - rounding);
    BOOST_TEST(found.highest <= exact.highest + 0.01 * std::max(exact.highest, 0.01 * largest) + rounding);
    BOOST_TEST(found.lowest <= exact.lowest + rounding);
    BOOST_TEST(found.lowest >= exact.lowest - 0.01 * largest - rounding);
    BOOST_TEST(found.states == static_cast<std::int64_t>(states.size()));
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(ends_are_those_of_eigen) {
  draws random;
  const fpu_chain<3> chain(50.0);
  check_states(chain, random_states(chain, random, 0.8, 50));
  const fpu_chain<> long_chain(30, 5.0);
  check_states(long_chain, random_states(long_chain, random, 0.8, 10));
  check_states(henon_heiles(), random_states(henon_heiles(), random, 0.8, 50));
  check_states(two_masses(), random_states(two_masses(), random, 0.8, 50));
  check_states(potential_only(), random_states(potential_only(), random, 0.8, 50));
  check_states(black_box_with_derivative(), random_states(black_box_with_derivative(), random, 0.8, 50));
}

// Bond lengths where the force pushes, and where it pulls ever less.
BOOST_AUTO_TEST_CASE(negative_curvature_does_not_pass_for_stiffness) {
  const auto at = [](double r) {
    const vector<double, 2> q(-0.5 * r, 0.5 * r);
    return phase_point<double, 2>{q, q};
  };
  const trapped_pair pair;
  check_states(pair, {at(0.95), at(1.0), at(1.2), at(1.5)});
  const states_of<trapped_pair> stretched{at(1.2)};
  check_states(pair, stretched);
  const auto found = hessian_spectrum(pair, stretched);
  BOOST_TEST(std::abs(found.highest_frequency() - std::sqrt(0.1)) < 1e-6);  // sqrt of rounding, and more
  BOOST_TEST(found.lowest < -14.0);

  // The same estimate from the wrong sign: the fastest departure passes for the highest frequency.
  BOOST_TEST(hessian_spectrum(upside_down(), stretched).highest_frequency() > 3.0);
}

// A hilltop has no frequency at all.
BOOST_AUTO_TEST_CASE(where_all_curvature_is_negative_the_highest_frequency_is_zero) {
  const black_box_with_derivative pendulum;
  const phase_point<double, 1> top{vector<double, 1>(3.14), vector<double, 1>(0.0)};
  const auto found = hessian_spectrum(pendulum, std::vector{top});
  BOOST_TEST(found.highest < 0.0);
  BOOST_TEST(found.highest_frequency() == 0.0);
}

BOOST_AUTO_TEST_CASE(soft_stiffness_is_that_without_the_quadratic_part) {
  const with_quadratic_part system(henon_heiles(), Eigen::MatrixXd::Identity(2, 2));
  const std::vector states{phase_point<double, 2>{vector<double, 2>(0.3, -0.2), vector<double, 2>(0.0, 0.0)}};
  const auto soft = hessian_spectrum<field::soft>(system, states);
  const auto all = hessian_spectrum(system, states);
  BOOST_TEST(std::abs(all.highest - soft.highest - 1.0) < 20.0 * eps);  // some ten operations
  BOOST_TEST(std::abs(all.lowest - soft.lowest - 1.0) < 20.0 * eps);
  BOOST_TEST(soft.highest > 0.1);
}

// The state before lends its directions; that must not blind for others.
BOOST_AUTO_TEST_CASE(the_order_of_states_does_not_matter_to_a_percent) {
  draws random;
  const fpu_chain<> chain(30, 5.0);
  auto states = random_states(chain, random, 0.8, 20);
  const auto one_way = hessian_spectrum(chain, states);
  std::reverse(states.begin(), states.end());
  const auto other_way = hessian_spectrum(chain, states);
  BOOST_TEST(std::abs(one_way.highest - other_way.highest) <= 0.01 * one_way.highest);
  BOOST_TEST(one_way.evaluations <= 40 * one_way.states);
}

BOOST_AUTO_TEST_CASE(nothing_to_look_at_is_refused) {
  BOOST_TEST(refuses<std::invalid_argument>(
      [] { hessian_spectrum(henon_heiles(), states_of<henon_heiles>()); }, {"states must", "none"}));
  const phase_point<double, 2> together{vector<double, 2>(0.0, 0.0), vector<double, 2>(0.0, 0.0)};
  BOOST_TEST(refuses<std::invalid_argument>([&] { hessian_spectrum(trapped_pair(), std::vector{together}); },
                                            {"finite derivative", "state 0"}));
}
