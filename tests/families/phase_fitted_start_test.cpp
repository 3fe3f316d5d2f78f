// SPDX-License-Identifier: BSL-1.0
// Of every family that can turn the oscillator exactly, a member that does.
#include "nysalt/families/phase_fitted_start.hpp"

#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

double largest_defect(const run_time_family& family, const Eigen::VectorXd& theta, double z) {
  return detail::defect_of_rotation(family.letters, family.coefficients(theta), family.symmetric, z * z)
      .lpNorm<Eigen::Infinity>();
}

bool can_turn(const run_time_family& family) {
  return family.letters.reads == field::whole && family.parameters() >= (family.symmetric ? 2 : 3);
}

}  // namespace

// The defects are of order 1 for a member that is not fitted, and computed by polynomials with coefficients
// of order 1 in z^2 <= 6.25, of degree 6 at most: 6.25^4 eps is 4e-13, and the solution is that far off
// again.
BOOST_AUTO_TEST_CASE_TEMPLATE(what_can_turn_the_oscillator_does, F, all_families) {
  const run_time_family family(F{});
  for (const double z : {1e-6, 0.4, 1.0, 2.5}) {
    const auto found = phase_fitted_start(family, z);
    if (!can_turn(family)) {
      BOOST_TEST(!found.has_value());
      continue;
    }
    if (!found) {  // there is no continuation from equal steps; nor of bab<3> so far
      const bool has_classical = family.starts.size() > 1;
      BOOST_TEST((!has_classical || (family.name == "bab3" && z == 2.5)));
      continue;
    }
    BOOST_TEST_CONTEXT(family.name << " at " << z) {
      BOOST_TEST(found->name == "phase_fitted");
      BOOST_TEST(family.is_in_range(found->theta));
      BOOST_TEST(largest_defect(family, found->theta, z) <= 1e-12);
      BOOST_TEST(largest_defect(family, found->theta, z + 0.01) > 1e-10);
    }
  }
}

BOOST_AUTO_TEST_CASE(it_is_the_phase_fitted_method_of_the_first_classical_member) {
  const auto found = phase_fitted_start(run_time_family(aba<5>{}), 2.0);
  BOOST_REQUIRE(found);
  const auto expected = phase_fitted<aba<5>, mclachlan5>(2.0).parameters();
  for (std::size_t k = 0; k < expected.size(); ++k) {
    BOOST_TEST(found->theta[static_cast<Eigen::Index>(k)] == expected[k]);
  }
}

BOOST_AUTO_TEST_CASE(letters_of_the_bath_count_for_nothing) {
  const run_time_family plain(fg4{});
  const auto expected = phase_fitted_start(plain, 2.0);
  const auto found = phase_fitted_start(thermostatted(plain, placement::symmetric), 2.0);
  BOOST_REQUIRE((expected && found));
  BOOST_TEST((found->theta == expected->theta));
}

// trace/2 = 1 - x/2 + K x^2 with K <= 1/32, where cos z has x^2/24.
BOOST_AUTO_TEST_CASE(two_kicks_cannot) {
  for (const double z : {0.1, 1.0, 2.0}) {
    BOOST_TEST(!phase_fitted_start(run_time_family(nystrom{}), z).has_value());
    BOOST_TEST(!phase_fitted_start(run_time_family(aba<2>{}), z).has_value());
  }
}

BOOST_AUTO_TEST_CASE(impossible_z_are_refused) {
  for (const double z : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { phase_fitted_start(run_time_family(fg4{}), z); },
                                              {"phase_fitted_start", "positive and finite"}));
  }
}

// Order four along the whole branch; tried where a = 0 is Chin's and at Omelyan's own a.
BOOST_AUTO_TEST_CASE(members_of_order_four_of_the_word_of_fg4) {
  const auto omelyan = fg4::of(omelyan_fg4());
  const auto ours = fg4::of_order_four(omelyan[0]);
  for (std::size_t k = 0; k < 3; ++k) BOOST_TEST(std::abs(ours[k] - omelyan[k]) <= 4.0 * eps);
  for (const double a : {-0.2, 0.0, 0.1, 0.14, 0.3}) {
    const auto theta = fg4::of_order_four(a);
    const run_time_family family(fg4{});
    // The two conditions of order four are the two of the oscillator: its defects at z = 0.
    BOOST_TEST(largest_defect(family, Eigen::Map<const Eigen::VectorXd>(theta.data(), 3), 0.0) <= 8.0 * eps);
    auto off = theta;
    off[2] += 1e-10;
    BOOST_TEST(largest_defect(family, Eigen::Map<const Eigen::VectorXd>(off.data(), 3), 0.0) > 8.0 * eps);
  }
  BOOST_TEST(refuses<std::invalid_argument>([] { fg4::of_order_four(0.5); }, {"of_order_four", "0.5"}));
}
