// SPDX-License-Identifier: BSL-1.0
// Modal coordinates: the modes with masses, without zero entries; there and back; modes that are refused.
#include "nysalt/detail/modal_coordinates.hpp"

#include <boost/test/unit_test.hpp>

#include <limits>

#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "support/refusal.hpp"
#include "support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Two springs whose modes are told from outside.
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

BOOST_AUTO_TEST_CASE(it_holds_the_modes_with_masses) {
  const linear_chain chain(Eigen::MatrixXd{{2.0, -2.0}, {-2.0, 5.0}}, Eigen::Vector2d(4.0, 9.0));
  const auto part = modal_coordinates::of(chain);
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
}

// U is orthogonal to some N eps, and each sum of two products rounds.
BOOST_AUTO_TEST_CASE(there_and_back_is_the_state) {
  const linear_chain chain(Eigen::MatrixXd{{2.0, -2.0}, {-2.0, 5.0}}, Eigen::Vector2d(4.0, 9.0));
  const auto modes = modal_coordinates::of(chain);
  const Eigen::Vector2d q(0.3, -1.7);
  const Eigen::Vector2d p(-0.2, 0.9);
  Eigen::Vector2d x, y, q_back, p_back;
  modes->to_modes(q, p, x, y);
  modes->from_modes(x, y, q_back, p_back);
  BOOST_TEST((q_back - q).norm() <= 32.0 * eps * q.norm());
  BOOST_TEST((p_back - p).norm() <= 32.0 * eps * p.norm());
  // H_0 is a sum of oscillators; with x for q it is another number.
  const double energy = 0.5 * (p[0] * p[0] / 4.0 + p[1] * p[1] / 9.0) +
                        chain.potential<double>(vector<double, Eigen::Dynamic>(q));
  const Eigen::Map<const Eigen::Vector2d> omega(modes->frequencies().data());
  BOOST_TEST(std::abs(0.5 * (y.squaredNorm() + omega.cwiseProduct(x).squaredNorm()) - energy) <=
             32.0 * eps * energy);
  BOOST_TEST(std::abs(0.5 * (y.squaredNorm() + omega.cwiseProduct(q).squaredNorm()) - energy) > 0.01);
}

BOOST_AUTO_TEST_CASE(entries_that_are_zero_are_left_out) {
  // Each mode of the chain has two masses of its own.
  BOOST_TEST(modal_coordinates::of(fpu_chain<>(8, 50.0))->entries().size() == 2U * 16U);
  BOOST_TEST(modal_coordinates::of(linear_chain::between_walls(4, 1.0))->entries().size() == 16U);
}

BOOST_AUTO_TEST_CASE(modes_that_cannot_be_are_refused) {
  const auto refused = [](const Eigen::MatrixXd& basis, const Eigen::VectorXd& frequencies) {
    return refuses<std::invalid_argument>(
        [&] {
          modal_coordinates::of(told{{basis, frequencies}});
        },
        {"two springs", "2 x 2", "frequency >= 0"});
  };
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  BOOST_TEST(!refused(identity, Eigen::Vector2d(0.0, 1.0)));
  BOOST_TEST(refused(Eigen::MatrixXd::Identity(3, 3), Eigen::Vector2d(0.0, 1.0)));
  BOOST_TEST(refused(Eigen::MatrixXd::Identity(2, 3), Eigen::Vector2d(0.0, 1.0)));
  BOOST_TEST(refused(identity, Eigen::VectorXd::Ones(1)));
  BOOST_TEST(refused(identity, Eigen::Vector2d(-1e-9, 1.0)));
  BOOST_TEST(refused(identity, Eigen::Vector2d(std::numeric_limits<double>::infinity(), 1.0)));
  BOOST_TEST(refused(identity * std::nan(""), Eigen::Vector2d(0.0, 1.0)));
}
