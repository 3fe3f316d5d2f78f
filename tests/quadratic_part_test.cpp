// SPDX-License-Identifier: BSL-1.0
// The quadratic part of a system: its modes laid out, what is zero left out, and modes that cannot be
// refused.
#include "nysalt/detail/quadratic_part.hpp"

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
  const auto part = quadratic_part::of(chain);
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

BOOST_AUTO_TEST_CASE(entries_that_are_zero_are_left_out) {
  // Each mode of the chain has two masses of its own.
  BOOST_TEST(quadratic_part::of(fpu_chain<>(8, 50.0))->entries().size() == 2U * 16U);
  BOOST_TEST(quadratic_part::of(linear_chain::between_walls(4, 1.0))->entries().size() == 16U);
}

BOOST_AUTO_TEST_CASE(modes_that_cannot_be_are_refused) {
  const auto refused = [](const Eigen::MatrixXd& basis, const Eigen::VectorXd& frequencies) {
    return refuses<std::invalid_argument>(
        [&] {
          quadratic_part::of(told{{basis, frequencies}});
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
