// SPDX-License-Identifier: BSL-1.0
// Stability windows have the known ends.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../laws/stability_law.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

auto windows_at(double b1, double beta1) { return stability_windows(member<nystrom>({b1, beta1})); }

/// First limit of a two-stage method from its one-step matrix on the oscillator: with s = c2 - c1 and
/// K = b1 b2 s (1 - s)/2, trace/2 = 1 - z^2/2 + K z^4.
double two_stage_limit(double b1, double beta1) {
  const auto c = nystrom::coefficients(std::array{b1, beta1});
  const double s = c[2];
  const double k = 0.5 * b1 * (1.0 - b1) * s * (1.0 - s);
  return std::sqrt(8.0 / (1.0 + std::sqrt(1.0 - 32.0 * k)));
}

/// A root of trace/2 = +-1 in z^2 errs by the trace's rounding over its slope, some ten operations; where
/// two windows nearly touch, the slope vanishes. Relative 1e-13 leaves room for a slope of 1/50.
const auto nearly = boost::test_tools::tolerance(1e-13);

}  // namespace

BOOST_AUTO_TEST_CASE(two_windows) {
  const auto windows = windows_at(0.5, 0.4);
  BOOST_REQUIRE(windows.size() == 2U);
  BOOST_TEST(windows[0].low == 0.0);
  BOOST_TEST(windows[0].high == std::sqrt(20.0 / 3.0), nearly);
  BOOST_TEST(windows[1].low == std::sqrt(10.0), nearly);
  BOOST_TEST(windows[1].high == std::sqrt(50.0 / 3.0), nearly);
}

// Two half steps of Verlet: at z = 2 sqrt 2 the matrix is -I, and the windows are one.
BOOST_AUTO_TEST_CASE(windows_that_touch_in_the_identity_are_one) {
  for (const auto& windows : {windows_at(0.5, 0.375), stability_windows(verlet_2x())}) {
    BOOST_REQUIRE(windows.size() == 1U);
    BOOST_TEST(windows[0].low == 0.0);
    BOOST_TEST(windows[0].high == 4.0, nearly);
  }
  BOOST_TEST(windows_at(0.5, 0.376).size() == 2U);
}

BOOST_AUTO_TEST_CASE(verlet_ends_at_two) {
  BOOST_TEST(stability_limit(verlet()) == 2.0, nearly);
  BOOST_TEST(stability_limit(verlet_aba()) == 2.0, nearly);
  BOOST_TEST(stability_limit(member<nystrom>({0.5, 0.5})) == 2.0, nearly);
}

BOOST_AUTO_TEST_CASE(two_stages_end_by_the_formula) {
  const auto [b1, beta1] = nystrom::start();
  BOOST_TEST(stability_limit(mclachlan2()) == two_stage_limit(b1, beta1),
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(std::abs(stability_limit(mclachlan2()) - 2.5531) < 5e-5);  // as printed
  BOOST_TEST(two_stage_limit(0.5, 0.4) == std::sqrt(20.0 / 3.0), nearly);
  draws random;
  int formula_holds = 0;
  for (int n = 0; n < 200; ++n) {
    const auto theta = random_theta<nystrom>(random);
    const double expected = two_stage_limit(theta[0], theta[1]);
    if (!(expected < 2.8)) continue;  // trace/2 stays above -1, or the two windows nearly touch
    ++formula_holds;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", b1 = " << theta[0] << ", beta1 = " << theta[1]) {
      BOOST_TEST(stability_limit(member<nystrom>(theta)) == expected, boost::test_tools::tolerance(1e-12));
    }
  }
  BOOST_TEST(formula_holds > 50);
}

// The trace does not tell which letter comes first.
BOOST_AUTO_TEST_CASE(the_same_coefficients_from_either_letter_have_the_same_windows) {
  const auto c = bcss2::coefficients();
  const auto a = stability_windows(alternating_word<drift, kick, 5>{}, c);
  const auto b = stability_windows(alternating_word<kick, drift, 5>{}, c);
  BOOST_REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    BOOST_TEST(a[i].low == b[i].low, nearly);
    BOOST_TEST(a[i].high == b[i].high, nearly);
  }
  BOOST_TEST(std::abs(a[0].high - stability_limit(mclachlan2())) > 1e-3);
}

BOOST_AUTO_TEST_CASE(a_band_is_stable_within_one_window) {
  const auto windows = windows_at(0.5, 0.4);
  BOOST_TEST(is_stable(windows, 0.0, 2.58));
  BOOST_TEST(is_stable(windows, 3.2, 4.0));
  BOOST_TEST(!is_stable(windows, 0.0, 2.6));
  BOOST_TEST(!is_stable(windows, 2.5, 3.2));  // the gap lies between
  BOOST_TEST(!is_stable(windows, 0.0, std::numeric_limits<double>::quiet_NaN()));
}

BOOST_AUTO_TEST_CASE(a_word_that_only_drifts_has_no_window) {
  const auto windows = stability_windows(word<drift>{}, std::array{1.0});
  BOOST_TEST(windows.empty());
}

BOOST_AUTO_TEST_CASE(a_method_that_is_never_stable_has_the_limit_zero) {
  const auto windows = stability_windows(word<drift, kick>{}, std::array{1.0, -1.0});
  BOOST_TEST((windows.empty() || windows.front().low > 0.0));
}
