// SPDX-License-Identifier: BSL-1.0
// What is asked of a system: evaluations, which are counted, and modes of a stiffness matrix, which lead to
// modal coordinates and back. That they diagonalise it is a law (systems/system_laws_test.cpp).
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/core.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

struct box {
  static constexpr int dimension = 1;
  std::shared_ptr<std::int64_t> calls = std::make_shared<std::int64_t>(0);
  void force(const vector<double, 1>& q, vector<double, 1>& f) const {
    ++*calls;
    f[0] = -std::sin(q[0]);
  }
};
struct with_potential : box {
  template <class T>
  T potential(const vector<T, 1>& q) const {
    using std::cos;
    return -cos(q[0]);
  }
};
static_assert(BlackBoxForce<box> && !BlackBoxForce<with_potential>);

template <class T, class S>
std::int64_t evaluations_over(const S& system, const vector<T, 1>& q = vector<T, 1>(T(2.0))) {
  const counted<S> watched(system);
  vector<T, 1> f(T(0.0));
  force<T>(watched, q, f);
  return watched.evaluations;
}

/// Three masses on two springs, held by nothing.
const Eigen::MatrixXd of_free_chain{{2.0, -2.0, 0.0}, {-2.0, 5.0, -3.0}, {0.0, -3.0, 3.0}};

/// Two springs whose normal modes are set by the caller.
struct told {
  static constexpr int dimension = 2;
  normal_modes given_modes;
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    f = -q;
  }
  normal_modes modes() const { return given_modes; }
  std::string description() const { return "two springs"; }
};

}  // namespace

// Of a black box each call counts: a difference of two for each direction, and two more where its step does
// not fit.
BOOST_AUTO_TEST_CASE(a_force_counts_one_and_each_call_of_a_black_box) {
  BOOST_TEST(evaluations_over<double>(box()) == 1);
  BOOST_TEST((evaluations_over<dual<double, 1>>(box()) == 3));
  BOOST_TEST((evaluations_over<dual<double, 2>>(box()) == 5));
  BOOST_TEST((evaluations_over<dual<double, 2>>(black_box_with_derivative()) == 3));
  // A potential that can be differentiated goes before differences.
  BOOST_TEST((evaluations_over<dual<double, 2>>(with_potential()) == 1));
  BOOST_TEST(detail::derivative_source<with_potential>() == std::string("automatic differentiation"));
  BOOST_TEST(detail::derivative_source<box>() == std::string("central differences of the force"));
  const box real;
  vector<dual<double, 2>, 1> q(dual<double, 2>(2.0));
  q[0].derivative = {1.0, 1e9};  // the second displacement is far too long
  const std::int64_t counted = evaluations_over<dual<double, 2>>(real, q);
  BOOST_TEST(counted == *real.calls);
  BOOST_TEST(counted > 5);
  vector<dual<double, 2>, 1> f(dual<double, 2>(0.0));
  force<dual<double, 2>>(real, q, f);
  BOOST_TEST(std::abs(f[0].derivative[1] / (-std::cos(2.0) * 1e9) - 1.0) < 1e-7);
}

// Where squares of entries overflow or underflow too. A power of four scales without rounding.
BOOST_AUTO_TEST_CASE(frequencies_scale_with_the_root_of_the_stiffness_and_zero_is_no_rounding) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(3);
  const auto known = detail::stiffness_modes(of_free_chain, ones, "test").frequencies;
  for (const int power : {-260, -1, 1, 260}) {
    const auto scaled =
        detail::stiffness_modes(std::ldexp(1.0, 2 * power) * of_free_chain, ones, "test").frequencies;
    BOOST_TEST((scaled == std::ldexp(1.0, power) * known), "4^" << power << ": " << scaled.transpose());
  }
  BOOST_TEST(known[0] == 0.0);
  BOOST_TEST(known[1] > 0.1);
  BOOST_TEST(detail::stiffness_modes(Eigen::MatrixXd::Zero(2, 2), Eigen::Vector2d(1.0, 1.0), "")
                 .frequencies.norm() == 0.0);
  const auto soft =
      detail::stiffness_modes(Eigen::Vector2d(1.0, 1e-12).asDiagonal(), Eigen::Vector2d(1.0, 1.0), "");
  BOOST_TEST(soft.frequencies[0] == 1e-6, tolerance(1e-3));  // eps/1e-12
}

BOOST_AUTO_TEST_CASE(what_is_no_stiffness_matrix_is_refused) {
  const auto refused = [](const Eigen::MatrixXd& stiffness, Eigen::Index masses, said words) {
    return refuses([&] { detail::stiffness_modes(stiffness, Eigen::VectorXd::Ones(masses), "who asks"); },
                   words);
  };
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(2, 2);
  BOOST_TEST(refused(Eigen::MatrixXd(0, 0), 0, {"who asks", "square", "0 x 0"}));
  BOOST_TEST(refused(Eigen::MatrixXd::Zero(2, 3), 2, {"square", "2 x 3"}));
  BOOST_TEST(refused(identity, 3, {"who asks", "masses", "2 coordinates", "got 3"}));
  BOOST_TEST(refused(identity * std::nan(""), 2, {"who asks", "must be finite"}));
  BOOST_TEST(refused(Eigen::MatrixXd{{1.0, 0.5}, {0.25, 1.0}}, 2, {"who asks", "symmetric"}));
  BOOST_TEST(refused(Eigen::Vector2d(1.0, -1e-3).asDiagonal(), 2, {"who asks", "must be >= 0", "-0.001"}));
  BOOST_TEST(!refused(of_free_chain, 3, {}));
}

BOOST_AUTO_TEST_CASE(modal_coordinates_are_the_modes_with_masses) {
  const linear_chain chain(Eigen::MatrixXd{{2.0, -2.0}, {-2.0, 5.0}}, Eigen::Vector2d(4.0, 9.0));
  const auto part = detail::modal_coordinates::of(chain);
  const auto modes = chain.modes();
  BOOST_REQUIRE(part->frequencies().size() == 2U);
  BOOST_REQUIRE(part->entries().size() == 4U);
  for (Eigen::Index k = 0; k < 2; ++k)
    BOOST_TEST(part->frequencies()[std::size_t(k)] == modes.frequencies[k]);
  for (const auto& [i, k, heavy, light] : part->entries()) {
    const double root = i == 0 ? 2.0 : 3.0;  // of the mass, whose inverse and root round
    BOOST_TEST(std::abs(heavy - modes.basis(i, k) * root) <= 4.0 * eps * root);
    BOOST_TEST(std::abs(light - modes.basis(i, k) / root) <= 4.0 * eps);
  }
  // There and back is the state: U is orthogonal to some N eps, and each sum of two products rounds.
  const Eigen::Vector2d q(0.3, -1.7);
  const Eigen::Vector2d p(-0.2, 0.9);
  Eigen::Vector2d x, y, q_back, p_back;
  part->to_modes(q, p, x, y);
  part->from_modes(x, y, q_back, p_back);
  BOOST_TEST((q_back - q).norm() <= 32.0 * eps * q.norm());
  BOOST_TEST((p_back - p).norm() <= 32.0 * eps * p.norm());
  // H_0 is a sum of oscillators; with q for x it is another number.
  const double energy = 0.5 * (p[0] * p[0] / 4.0 + p[1] * p[1] / 9.0) +
                        chain.potential<double>(vector<double, Eigen::Dynamic>(q));
  const Eigen::Map<const Eigen::Vector2d> omega(part->frequencies().data());
  const auto sum = [&](const Eigen::Vector2d& of) {
    return 0.5 * (y.squaredNorm() + omega.cwiseProduct(of).squaredNorm());
  };
  BOOST_TEST(std::abs(sum(x) - energy) <= 32.0 * eps * energy);
  BOOST_TEST(std::abs(sum(q) - energy) > 0.01);
  // Entries that are zero are left out: each mode of this chain has two masses of its own.
  BOOST_TEST(detail::modal_coordinates::of(fpu_chain<>(8, 50.0))->entries().size() == 2U * 16U);
}

BOOST_AUTO_TEST_CASE(modes_that_cannot_be_are_refused) {
  const auto refused = [](const Eigen::MatrixXd& basis, const Eigen::VectorXd& frequencies) {
    const told system{{basis, frequencies}};
    return refuses([&] { detail::modal_coordinates::of(system); },
                   {"two springs", "2 x 2", "frequency >= 0"});
  };
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  const Eigen::Vector2d right(0.0, 1.0);
  BOOST_TEST(!refused(identity, right));
  BOOST_TEST(refused(Eigen::MatrixXd::Identity(3, 3), right));
  BOOST_TEST(refused(Eigen::MatrixXd::Identity(2, 3), right));
  BOOST_TEST(refused(identity, Eigen::VectorXd::Ones(1)));
  BOOST_TEST(refused(identity, Eigen::Vector2d(-1e-9, 1.0)));
  BOOST_TEST(refused(identity, Eigen::Vector2d(infinite, 1.0)));
  BOOST_TEST(refused(identity * std::nan(""), right));
}
