// SPDX-License-Identifier: BSL-1.0
// A quadratic part split off changes nothing but what is soft.
#include "nysalt/systems/with_quadratic_part.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
const Eigen::MatrixXd spring{{1.0, -1.0}, {-1.0, 1.0}};  // that of two_masses

}  // namespace

static_assert(HasQuadraticPart<with_quadratic_part<two_masses>>);
static_assert(HasQuadraticPart<with_quadratic_part<potential_only>>);
static_assert(!HasQuadraticPart<two_masses> && !HasQuadraticPart<potential_only>);

BOOST_AUTO_TEST_CASE(what_is_soft_is_the_force_without_the_quadratic_part) {
  const with_quadratic_part split(two_masses(), spring);
  draws random;
  for (int n = 0; n < 10; ++n) {
    const auto q = random.state(split, 1.0).q;
    vector<double, 2> soft;
    split.soft_force(q, soft);
    for (Eigen::Index i = 0; i < 2; ++i) {
      BOOST_TEST(std::abs(soft[i] + q[i] * q[i] * q[i]) <= 8.0 * eps);  // eight operations below 1
    }
    vector<double, 2> whole;
    vector<double, 2> alone;
    force<double>(split, q, whole);
    force<double>(two_masses(), q, alone);
    BOOST_TEST((whole == alone));
    BOOST_TEST((whole - soft).norm() > 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(the_modes_are_those_of_the_matrix_and_the_masses) {
  const auto modes = with_quadratic_part(two_masses(), spring).modes();
  BOOST_TEST(modes.frequencies[0] == 0.0);
  BOOST_TEST(std::abs(modes.frequencies[1] - std::sqrt(1.25)) <= 8.0 * eps);  // 1/m1 + 1/m2
  const auto unit = with_quadratic_part(henon_heiles(), Eigen::MatrixXd::Identity(2, 2)).modes();
  BOOST_TEST((unit.frequencies - Eigen::Vector2d::Ones()).norm() <= 4.0 * eps);
}

BOOST_AUTO_TEST_CASE(it_says_what_was_split_off) {
  const with_quadratic_part split(henon_heiles(), Eigen::MatrixXd::Identity(2, 2) * 4.0);
  BOOST_TEST(describe(split) == describe(henon_heiles()) + " with a quadratic part of frequencies up to 2");
  BOOST_TEST(describe(split.base()) == describe(henon_heiles()));
}

BOOST_AUTO_TEST_CASE(a_matrix_that_does_not_fit_is_refused) {
  const auto made = [](const Eigen::MatrixXd& stiffness) {
    return [=] { with_quadratic_part(henon_heiles(), stiffness); };
  };
  BOOST_TEST(refuses<wrong>(made(Eigen::MatrixXd::Identity(3, 3)), {"with_quadratic_part"}));
  BOOST_TEST(refuses<wrong>(made(-Eigen::MatrixXd::Identity(2, 2)), {"with_quadratic_part", "must be >= 0"}));
  BOOST_TEST(refuses<wrong>(made(Eigen::MatrixXd{{1.0, 2.0}, {0.0, 1.0}}), {"symmetric"}));
  BOOST_TEST(!refuses<wrong>(made(Eigen::MatrixXd::Zero(2, 2)), {}));
}
