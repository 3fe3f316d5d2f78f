// SPDX-License-Identifier: BSL-1.0
// The ends of the spectrum of a Hessian, and the frequencies of the linearised motion, against Eigen's
// eigenvalues.
#include "nysalt/derivatives/spectrum.hpp"
#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/core.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

Eigen::VectorXd random_vector(draws& random, Eigen::Index n) {
  Eigen::VectorXd v(n);
  for (double& x : v) x = random.uniform(-1.0, 1.0);
  return v;
}

/// With these eigenvalues, in a basis of chance.
Eigen::MatrixXd symmetric(draws& random, const Eigen::VectorXd& eigenvalues) {
  const Eigen::Index n = eigenvalues.size();
  Eigen::MatrixXd a(n, n);
  for (Eigen::Index k = 0; k < n; ++k) a.col(k) = random_vector(random, n);
  const Eigen::MatrixXd basis = orthogonal_basis(a);
  return basis * eigenvalues.asDiagonal() * basis.transpose();
}

detail::spectrum_ends ends_of(const Eigen::MatrixXd& a, const Eigen::VectorXd& start) {
  return detail::ends_of_spectrum([&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return a * v; }, start);
}

/// Products and projections round each entry of A by some n eps of its size.
double rounding_of(const Eigen::VectorXd& eigenvalues) {
  return 10.0 * static_cast<double>(eigenvalues.size()) * eps * eigenvalues.cwiseAbs().maxCoeff();
}

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
    Eigen::VectorXd root = Eigen::VectorXd::Ones(state.size());
    if constexpr (HasInverseMass<S>) {
      for (Eigen::Index i = 0; i < root.size(); ++i) root[i] = std::sqrt(system.inverse_mass(i));
    }
    const Eigen::MatrixXd a = root.asDiagonal() * hessian(system, state.q) * root.asDiagonal();
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

BOOST_AUTO_TEST_CASE(small_spectra_are_found_to_rounding) {
  draws random;
  for (Eigen::Index n = 1; n <= 8; ++n) {
    const Eigen::VectorXd values = 100.0 * random_vector(random, n);
    const auto ends = ends_of(symmetric(random, values), random_vector(random, n));
    BOOST_TEST(std::abs(ends.highest - values.maxCoeff()) <= rounding_of(values));
    BOOST_TEST(std::abs(ends.lowest - values.minCoeff()) <= rounding_of(values));
  }
}

// The residual, by which each end is moved outwards, is 1 % at the end; the Ritz value is inside the
// spectrum.
BOOST_AUTO_TEST_CASE(large_spectra_are_bounded_within_two_percent) {
  draws random;
  for (const double lowest : {-1.0, 0.0, -20.0}) {
    Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(200, lowest, 1.0);
    const auto ends = ends_of(symmetric(random, values), random_vector(random, 200));
    BOOST_TEST_CONTEXT("lowest " << lowest) {
      BOOST_TEST(std::abs(ends.highest - 1.0) <= 0.01);
      BOOST_TEST(std::abs(ends.lowest - lowest) <= 0.01 * std::max(1.0, -lowest));
      BOOST_TEST(ends.products < 100);
    }
  }
}

// The ends are bounds: a Ritz value lies inside the spectrum, and is moved outwards by its residual, at most
// 0.01, within which some eigenvalue lies: the end itself where all others are 0.1 away.
BOOST_AUTO_TEST_CASE(isolated_ends_are_not_passed_inwards) {
  constexpr Eigen::Index n = 200;
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(n, -0.9, 0.9);
  values[0] = -1.0;
  values[n - 1] = 1.0;
  const auto multiply = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return values.cwiseProduct(v); };
  draws random;
  for (int trial = 0; trial < 4; ++trial) {
    const auto ends = detail::ends_of_spectrum(multiply, random_vector(random, n));
    BOOST_TEST(ends.highest >= 1.0);
    BOOST_TEST(ends.lowest <= -1.0);
    // By Rayleigh quotients of the Ritz vectors: the values themselves are inside.
    BOOST_TEST(ends.highest_direction.dot(multiply(ends.highest_direction)) < 1.0);
    BOOST_TEST(ends.lowest_direction.dot(multiply(ends.lowest_direction)) > -1.0);
  }
}

BOOST_AUTO_TEST_CASE(eigenvalues_that_are_all_one_are_found_at_once_and_none_of_what_is_not_finite) {
  const auto multiple = ends_of(4.0 * Eigen::MatrixXd::Identity(20, 20), Eigen::VectorXd::Ones(20));
  BOOST_TEST(multiple.products <= 2);
  BOOST_TEST(std::abs(multiple.highest - 4.0) < 1e-11);  // closed where the rest is 1e-12 of the size
  BOOST_TEST(std::abs(multiple.lowest - 4.0) < 1e-11);
  const auto nothing = ends_of(Eigen::MatrixXd::Zero(20, 20), Eigen::VectorXd::Ones(20));
  BOOST_TEST((nothing.highest == 0.0 && nothing.lowest == 0.0));
  Eigen::MatrixXd infinite = Eigen::MatrixXd::Identity(3, 3);
  infinite(1, 1) = std::numeric_limits<double>::infinity();
  BOOST_TEST(std::isnan(ends_of(infinite, Eigen::Vector3d::Ones()).highest));
}

BOOST_AUTO_TEST_CASE(ends_are_those_of_eigen) {
  draws random;
  const auto check = [&](const auto& system, int count) {
    check_states(system, random_states(system, random, 0.8, count));
  };
  check(fpu_chain<3>(50.0), 50);
  check(fpu_chain<>(30, 5.0), 10);
  check(henon_heiles(), 50);
  check(two_masses(), 50);
  check(potential_only(), 50);
  check(black_box_with_derivative(), 50);
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
}

// A hilltop has no frequency at all.
BOOST_AUTO_TEST_CASE(where_all_curvature_is_negative_the_highest_frequency_is_zero) {
  const phase_point<double, 1> top{vector<double, 1>(3.14), vector<double, 1>(0.0)};
  const auto found = hessian_spectrum(black_box_with_derivative(), std::vector{top});
  BOOST_TEST(found.highest < 0.0);
  BOOST_TEST(found.highest_frequency() == 0.0);
}

BOOST_AUTO_TEST_CASE(soft_stiffness_is_that_without_the_quadratic_part) {
  const with_quadratic_part system(henon_heiles(), Eigen::MatrixXd::Identity(2, 2));
  const std::vector states{phase_point<double, 2>{vector<double, 2>(0.3, -0.2), vector<double, 2>(0.0, 0.0)}};
  const auto soft = hessian_spectrum(system, states, field::soft);
  const auto all = hessian_spectrum(system, states);
  BOOST_TEST(std::abs(all.highest - soft.highest - 1.0) < 20.0 * eps);  // some ten operations
  BOOST_TEST(std::abs(all.lowest - soft.lowest - 1.0) < 20.0 * eps);
  BOOST_TEST(soft.highest > 0.1);
}

// The state before lends its directions.
BOOST_AUTO_TEST_CASE(a_state_among_others_takes_few_evaluations) {
  draws random;
  const fpu_chain<> chain(30, 5.0);
  const auto found = hessian_spectrum(chain, random_states(chain, random, 0.8, 20));
  BOOST_TEST(found.evaluations <= 40 * found.states);
}

BOOST_AUTO_TEST_CASE(nothing_to_look_at_is_refused) {
  BOOST_TEST(
      refuses([] { hessian_spectrum(trapped_pair(), states_of<trapped_pair>()); }, {"states must", "none"}));
  const phase_point<double, 2> together{vector<double, 2>(0.0, 0.0), vector<double, 2>(0.0, 0.0)};
  BOOST_TEST(refuses([&] { hessian_spectrum(trapped_pair(), std::vector{together}); },
                     {"finite derivative", "state 0"}));
}

BOOST_AUTO_TEST_CASE(all_frequencies_of_a_state_are_those_of_the_hessian) {
  draws random;
  const dynamic_potential ring{5};
  for (int n = 0; n < 10; ++n) {
    const auto state = random.state(ring, 0.8);
    const Eigen::VectorXd squares = symmetric_eigen(hessian(ring, state.q)).values;
    const auto found = detail::frequencies_at(ring, state);
    BOOST_REQUIRE(std::ssize(found) == squares.size());
    for (std::size_t k = 0; k < found.size(); ++k) {  // squares of order ten that are known to rounding
      const double square = std::max(0.0, squares[static_cast<Eigen::Index>(k)]);
      BOOST_TEST(std::abs(found[k] * found[k] - square) < 1e-12);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_kinetic_energy_of_any_kind_counts) {
  for (const double p : {0.0, 0.5, 2.0}) {
    for (const double q : {0.0, 0.3, 1.0}) {
      const auto found = detail::frequencies_at(
          fast_particle{}, {Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, p)});
      const double expected = std::sqrt((100.0 + 240.0 * q * q) * std::pow(1.0 + p * p, -1.5));
      BOOST_TEST(std::abs(found[0] / expected - 1.0) < 1e-14);
    }
  }
}

BOOST_AUTO_TEST_CASE(of_large_systems_the_highest_alone_is_known) {
  draws random;
  const dynamic_potential large{detail::most_for_all_frequencies + 1};
  const std::vector states{random.state(large, 0.5), random.state(large, 0.5)};
  const auto found = detail::frequencies_of_states(large, states);
  BOOST_TEST(!found.are_complete);
  BOOST_REQUIRE(found.of_state.size() == 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    const double highest = std::sqrt(symmetric_eigen(hessian(large, states[n].q)).values.maxCoeff());
    BOOST_TEST(std::abs(found.of_state[n][0] / highest - 1.0) < 0.01);
  }
  BOOST_TEST(found.highest().frequency == std::max(found.of_state[0][0], found.of_state[1][0]));
}
