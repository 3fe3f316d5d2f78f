// SPDX-License-Identifier: BSL-1.0
// Three independent references agree on a chain with masses and a zero frequency.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../support/rounding.hpp"
#include "nysalt/counted.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/references/odeint.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double duration = 3.0;
using point = phase_point<double, Eigen::Dynamic>;

point after(const auto& reference, const linear_chain& system, point x) {
  reference.advance(system, x, duration);
  return x;
}

/// Rounding of the exact flow: two transforms of n terms each, on numbers magnified by t (free motion), by
/// the frequencies and by the roots of the masses, all below 6; cos and sin err by eps w t.
double exact_rounding(const point& x) { return 16.0 * 6.0 * 3.0 * eps * size_of(x); }

}  // namespace

BOOST_AUTO_TEST_CASE(exact_odeint_and_fine_steps_agree) {
  const linear_chain system = free_chain();
  BOOST_REQUIRE(system.modes().frequencies[0] == 0.0);
  draws random;
  for (int n = 0; n < 5; ++n) {
    const point x = random.state(system, 1.0);
    const point exact = after(exact_linear(system), system, x);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", draw " << n) {
      // Some t w/h = 600 steps of 23 letters, each of which rounds twice. Free motion magnifies by t.
      const double step = duration / 600.0;
      const double rounding = 600.0 * 23.0 * 2.0 * eps * size_of(x) * (1.0 + duration);
      BOOST_TEST(distance(after(fine_steps(step), system, x), exact) <= rounding + exact_rounding(x));
      // Each accepted step, at most a 13th of the evaluations, errs by the tolerance times 1 + |x|.
      const counted<linear_chain> watched(system);
      point by_odeint = x;
      odeint_reference(1e-12).advance(watched, by_odeint, duration);
      const double steps = static_cast<double>(watched.evaluations) / 13.0;
      BOOST_TEST(distance(by_odeint, exact) <=
                 steps * 2e-12 * size_of(x) * (1.0 + duration) + exact_rounding(x));
      // A coarse reference is told apart.
      BOOST_TEST(distance(after(fine_steps<verlet>(0.3), system, x), exact) > 1e-4);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_exact_flow_is_a_group) {
  const linear_chain system = free_chain();
  draws random;
  const point x = random.state(system, 1.0);
  const exact_linear exact(system);
  point there_and_back = x;
  exact.advance(system, there_and_back, 2.0);
  exact.advance(system, there_and_back, -2.0);
  BOOST_TEST(distance(there_and_back, x) <= 4.0 * exact_rounding(x));
  point in_two = x;
  exact.advance(system, in_two, 1.25);
  exact.advance(system, in_two, duration - 1.25);
  BOOST_TEST(distance(in_two, after(exact, system, x)) <= 4.0 * exact_rounding(x));
}

BOOST_AUTO_TEST_CASE(the_centre_of_mass_moves_freely) {
  const linear_chain system = free_chain();
  point x{Eigen::VectorXd::Zero(3), Eigen::Vector3d(1.0, 2.0, 5.0)};  // velocity 1 each
  exact_linear(system).advance(system, x, duration);
  for (int i = 0; i < 3; ++i) BOOST_TEST(std::abs(x.q[i] - duration) <= 5.0 * exact_rounding(x));
}

BOOST_AUTO_TEST_CASE(the_exact_flow_reports_no_error_of_its_own) {
  const linear_chain system = free_chain();
  draws random;
  BOOST_TEST(reference_error(system, exact_linear(system), random.state(system, 1.0), duration) == 0.0);
}
