// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 49 s at -O0, 1.2 s at -O1.
// Stability windows: their known ends, an oracle by eigenvalues, and what steps and long runs do on either
// side of an end.
#include <boost/test/unit_test.hpp>

#include "../laws/laws.hpp"
#include "../laws/stability_law.hpp"
#include "../support/dense.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/scalars/series.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

auto windows_at(double b1, double beta1) {
  return stability_windows(tabulated(member<nystrom>({b1, beta1})));
}

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

/// sum_k c[k] x^k, k <= 8.
using polynomial = series<8>;

/// q'' = -x q with the variable x of polynomials: what a stepper makes of it is the matrix of a word.
struct variable_oscillator {
  static constexpr int dimension = 1;
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = -(q[0] * polynomial::variable());
  }
};

polynomial half_trace_of(const tabulated& method) {
  const variable_oscillator system;
  const stepper<variable_oscillator, run_time_word> one(system, method.letters(), method.coefficients(), 1.0);
  phase_point<polynomial, 1> from_q{vector<polynomial, 1>(polynomial(1.0)),
                                    vector<polynomial, 1>(polynomial(0.0))};
  phase_point<polynomial, 1> from_p{vector<polynomial, 1>(polynomial(0.0)),
                                    vector<polynomial, 1>(polynomial(1.0))};
  one.step(from_q);
  one.step(from_p);
  return (from_q.q[0] + from_p.p[0]) * 0.5;
}

/// Positive z where trace/2 passes +-1, by the eigenvalues of companion matrices: an oracle that has nothing
/// in common with what finds the windows. Complex roots with a small imaginary part are left out.
std::vector<double> ends_by_eigenvalues(const tabulated& method) {
  std::vector<double> ends;
  for (const double y : {-1.0, 1.0}) {
    const auto all = (half_trace_of(method) - polynomial(y)).coefficient;
    std::vector<double> c(all.begin() + (y > 0.0 ? 1 : 0), all.end());  // x = 0 is no end
    double largest = 0.0;
    for (const double a : c) largest = std::max(largest, std::abs(a));
    while (std::abs(c.back()) <= 1e-18 * largest) c.pop_back();
    const auto degree = static_cast<Eigen::Index>(c.size()) - 1;
    if (degree < 1) continue;
    Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
    companion.diagonal(-1).setOnes();
    for (Eigen::Index i = 0; i < degree; ++i)
      companion(i, degree - 1) = -c[static_cast<std::size_t>(i)] / c.back();
    for (const auto& x : eigenvalues(companion)) {
      if (x.real() > 0.0 && std::abs(x.imag()) <= 1e-9 * x.real()) ends.push_back(std::sqrt(x.real()));
    }
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

/// Whether the windows have these ends, to a relative error of 1e-6: eigenvalues of companion matrices of
/// degree 6 err by some 1e-9, and more where two are near.
bool have_ends(const std::vector<stability_window>& windows, const std::vector<double>& expected) {
  std::vector<double> ends;
  for (const auto& [low, high] : windows) {
    if (low > 0.0) ends.push_back(low);
    ends.push_back(high);
  }
  return std::ranges::equal(ends, expected,
                            [](double a, double b) { return std::abs(a - b) <= 1e-6 * std::abs(b); });
}

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
    const std::array theta{random.uniform(0.2, 0.8), random.uniform(0.1, 0.4)};
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
  const auto a = stability_windows(run_time_word("ABABA"), {c.begin(), c.end()});
  const auto b = stability_windows(run_time_word("BABAB"), {c.begin(), c.end()});
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

BOOST_AUTO_TEST_CASE(what_is_never_stable_has_no_window) {
  BOOST_TEST(stability_windows(run_time_word("A"), {1.0}).empty());
  const auto windows = stability_windows(run_time_word("AB"), {1.0, -1.0});
  BOOST_TEST((windows.empty() || windows.front().low > 0.0));
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    BOOST_TEST(stability_windows(run_time_word("BAB"), {0.5, wrong, 0.5}).empty());
  }
}

BOOST_AUTO_TEST_CASE(windows_end_at_the_eigenvalues_of_companion_matrices) {
  draws random;
  int compared = 0;
  for (int n = 0; n < 5; ++n) {
    for (const auto& method : methods_as_data(random)) {
      if (has_rotation(method.letters()) || method.letters().evaluations_of_plain_step > 7) continue;
      // It ends at a threefold root, and with a displaced kick is the same on oscillators.
      if (method.name().starts_with(chin4a().name())) continue;
      const auto windows = stability_windows(method);
      // Ends that are nearly one are no simple eigenvalues.
      double nearest = windows.front().high;
      for (std::size_t i = 1; i < windows.size(); ++i) {
        nearest = std::min({nearest, windows[i].high - windows[i].low, windows[i].low - windows[i - 1].high});
      }
      const bool touches = !chart_stability(method.letters(), method.coefficients()).touching.empty();
      if (touches || nearest < 1e-2) continue;
      ++compared;
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << ", draw " << n) {
        BOOST_TEST(have_ends(windows, ends_by_eigenvalues(method)));
      }
    }
  }
  BOOST_TEST(compared > 50);
}

// Wrong by a hundredth, without a gap, or with one too many: the oracle does not agree.
BOOST_AUTO_TEST_CASE(wrong_windows_are_found_by_the_eigenvalues) {
  const tabulated method(member<nystrom>({0.5, 0.4}));
  const auto ends = ends_by_eigenvalues(method);
  const auto windows = stability_windows(method);
  BOOST_REQUIRE(windows.size() == 2U);
  BOOST_TEST(have_ends(windows, ends));
  BOOST_TEST(!have_ends({windows[0], {windows[1].low, 1.01 * windows[1].high}}, ends));
  BOOST_TEST(!have_ends({{0.0, windows[1].high}}, ends));
  BOOST_TEST(!have_ends({{0.0, 1.0}, {1.1, windows[0].high}, windows[1]}, ends));
}

// trace/2 + 1 = -(z^2 - 12)^3/864: values tell a threefold root to the third root of rounding only.
BOOST_AUTO_TEST_CASE(a_threefold_root_is_known_as_well_as_others) {
  BOOST_TEST(stability_limit(chin4a()) == std::sqrt(12.0), nearly);
  BOOST_TEST(stability_windows(chin4a()).size() == 1U);
}

BOOST_AUTO_TEST_CASE(letters_that_the_oscillator_lacks_are_refused) {
  using error = std::invalid_argument;
  const auto chart = [](const char* letters, const std::vector<double>& c) {
    return chart_stability(run_time_word(letters), c);
  };
  BOOST_CHECK_THROW(chart("RSR", {0.5, 1.0, 0.5}), error);
  BOOST_CHECK_THROW(chart("S", {1.0}), error);
  BOOST_CHECK_THROW(chart("BAB", {0.5, 1.0}), error);
  BOOST_TEST(chart("OBABO", {0.5, 0.5, 1.0, 0.5, 0.5}).windows.back().high == 2.0, nearly);
}

BOOST_AUTO_TEST_CASE(windows_end_where_the_spectral_radius_leaves_one) {
  draws random;
  for (int n = 0; n < 2; ++n) {
    for (const auto& method : methods_as_data(random)) {
      if (has_rotation(method.letters())) continue;
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << ", draw " << n) {
        BOOST_TEST(!stability_windows(method).empty());
        try_ends(
            method, 1e-3, 1e-3,
            [&](double z) { BOOST_TEST(spectral_radius(method, z) <= 1.0 + radius_rounding(method, z)); },
            [&](double z) { BOOST_TEST(spectral_radius(method, z) > 1.0 + radius_rounding(method, z)); });
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(long_runs_stay_bounded_inside_and_diverge_outside) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    if (has_rotation(method.letters())) continue;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
      try_ends(
          method, 1e-3, 0.5,  // in the middle of a narrow gap, where 100,000 steps suffice
          [&](double z) { BOOST_TEST(largest_in_long_run(method, z) <= bound_of_long_run(method, z)); },
          [&](double z) { BOOST_TEST(!(largest_in_long_run(method, z) <= 1e9)); });
    }
  }
}

// Between the windows: a claim that they are one must fail.
BOOST_AUTO_TEST_CASE(the_gap_between_windows_is_unstable) {
  const tabulated method(member<nystrom>({0.5, 0.4}));
  BOOST_TEST(spectral_radius(method, 2.5) <= 1.0 + radius_rounding(method, 2.5));
  BOOST_TEST(spectral_radius(method, 2.9) > 1.1);
  BOOST_TEST(spectral_radius(method, 3.5) <= 1.0 + radius_rounding(method, 3.5));
}
