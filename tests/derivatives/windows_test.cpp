// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 80 s at -O0, 1.9 s at -O1.
// Stability windows: their known ends, and what the eigenvalues of steps do on either side of an end and on a
// grid; margins, stable steps and touching windows in closed form; and the Bernstein
// polynomials that enclose trace/2.
#include "../laws/laws.hpp"
#include "../support/dense.hpp"
#include "../support/members.hpp"
#include "nysalt/core.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/scalars/polynomial.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The oscillator of frequency 1, so that z is the step.
const harmonic_oscillator unit_oscillator(1.0);
const phase_point<double, 1> at_one{vector<double, 1>(1.0), vector<double, 1>(1.0)};
using windows = std::vector<stability_window>;

/// The eigenvalues' largest absolute value, from the exact Jacobian of a step.
double spectral_radius(const method& method, double z) {
  const Eigen::MatrixXd step = detail::jacobian(detail::step_map(unit_oscillator, method, z), at_one);
  return test::spectral_radius(step);
}

/// What rounding may add to it where the eigenvalues are apart: the determinant, 1, is their squared size,
/// and errs by 2 |J| |dJ|. Letter k rounds the product P_k so far, by 2 eps |L_k| |P_k|, and the letters
/// after it carry that on.
double radius_rounding(const method& method, double z) {
  const word& all = method.letters();
  const std::string_view letters = all.view();
  const auto& c = method.coefficients();
  std::vector<Eigen::Matrix2d> so_far;
  std::vector<Eigen::Matrix2d> letter(letters.size(), Eigen::Matrix2d::Identity());
  Eigen::Matrix2d product = Eigen::Matrix2d::Identity();
  for (std::size_t k = 0; k < letters.size(); ++k) {
    const std::size_t slot = all.first_slot(k);
    if (letters[k] == 'B') letter[k](1, 0) = -c[slot] * z;
    if (letters[k] == 'G') letter[k](1, 0) = -c[slot] * z + 2.0 * c[slot + 1] * z * z * z;
    if (letters[k] == 'A') letter[k](0, 1) = c[slot] * z;
    product = letter[k] * product;
    so_far.push_back(product);
  }
  double error = 0.0;
  Eigen::Matrix2d rest = Eigen::Matrix2d::Identity();
  for (std::size_t k = letters.size(); k-- > 0;) {
    error += 2.0 * eps * norm(rest) * norm(letter[k]) * norm(so_far[k]);
    rest = rest * letter[k];
  }
  return 2.0 * norm(product) * error;
}

bool has_radius_one(const method& method, double z) {
  return spectral_radius(method, z) <= 1.0 + radius_rounding(method, z);
}

const windows of_verlet{{0.0, 2.0}};
/// Of the two-stage word (1/2, 2/5).
const double end = std::sqrt(20.0 / 3.0);
const double again = std::sqrt(10.0);
const double last = std::sqrt(50.0 / 3.0);
const windows with_a_gap{{0.0, end}, {again, last}};

auto windows_at(double b1, double beta1) { return stability_windows(member(nystrom(), {b1, beta1})); }
stability_chart chart_of(const std::string& letters, const auto& c) {
  return chart_stability(word(letters), {c.begin(), c.end()});
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
const auto nearly = tolerance(1e-13);

/// The first z of a grid, which goes past the last window, where steps are not as stable as the windows say,
/// or 0. Next to an end rounding decides.
double first_wrong(const windows& claimed, const method& method) {
  for (double z = 0.0137; z < std::max(12.0, 1.2 * claimed.back().high); z += 0.0137) {
    const bool is_at_end = std::ranges::any_of(claimed, [&](const auto& one) {
      return std::abs(z - one.low) < 1e-3 || std::abs(z - one.high) < 1e-3;
    });
    if (is_at_end || radius_rounding(method, z) > 1e-6) continue;
    if (has_radius_one(method, z) != is_stable(claimed, z, z)) return z;
  }
  return 0.0;
}

/// n steps of symplectic Euler, each 1/n of the whole.
stability_chart chart_of_eulers(std::size_t n) {
  std::string letters;
  for (std::size_t i = 0; i < n; ++i) letters += "AB";
  return chart_of(letters, std::vector<double>(2 * n, 1.0 / static_cast<double>(n)));
}

/// (x - r_1) (x - r_2) ... on low..high.
detail::bernstein_polynomial with_roots(double low, double high, const std::vector<double>& roots) {
  detail::bernstein_polynomial product(low, high, 1.0);
  for (const double r : roots) {
    auto next = product.times_x();
    next += -r * product;
    product = next;
  }
  return product;
}

/// Chebyshev's polynomial of degree n on -1..1, between -1 and 1, which it takes n + 1 times.
detail::bernstein_polynomial chebyshev(int n, double low, double high) {
  detail::bernstein_polynomial before(low, high, 1.0);
  auto here = before.times_x();
  for (int k = 1; k < n; ++k) {
    auto after = 2.0 * here.times_x();
    after += -1.0 * before;
    before = here;
    here = after;
  }
  return here;
}

}  // namespace

// Of Chin's method trace/2 + 1 = -(z^2 - 12)^3/864: values tell a threefold root to the third root of
// rounding only.
BOOST_AUTO_TEST_CASE(windows_end_where_they_are_known_to_end) {
  const auto found = windows_at(0.5, 0.4);
  BOOST_REQUIRE(found.size() == 2U);
  for (const std::size_t i : {0U, 1U}) {
    BOOST_TEST(found[i].low == with_a_gap[i].low, nearly);
    BOOST_TEST(found[i].high == with_a_gap[i].high, nearly);
  }
  for (const double limit : {stability_limit(verlet()), stability_limit(verlet_aba()),
                             stability_limit(member(nystrom(), {0.5, 0.5}))})
    BOOST_TEST(limit == 2.0, nearly);
  BOOST_TEST(stability_limit(chin4a()) == std::sqrt(12.0), nearly);
  BOOST_TEST(stability_windows(chin4a()).size() == 1U);
}

BOOST_AUTO_TEST_CASE(two_stages_end_by_the_formula) {
  const auto [b1, beta1] = nystrom::start();
  BOOST_TEST(stability_limit(mclachlan2()) == two_stage_limit(b1, beta1), tolerance(1e-12));
  BOOST_TEST(std::abs(stability_limit(mclachlan2()) - 2.5531) < 5e-5);  // as printed
  BOOST_TEST(two_stage_limit(0.5, 0.4) == std::sqrt(20.0 / 3.0), nearly);
  draws random;
  int formula_holds = 0;
  for (int n = 0; n < 200; ++n) {
    const std::array theta{random.uniform(0.2, 0.8), random.uniform(0.1, 0.4)};
    const double expected = two_stage_limit(theta[0], theta[1]);
    if (!(expected < 2.8)) continue;  // trace/2 stays above -1, or the two windows nearly touch
    ++formula_holds;
    BOOST_TEST(stability_limit(member_at(nystrom(), theta)) == expected, tolerance(1e-12));
  }
  BOOST_TEST(formula_holds > 50);
}

BOOST_AUTO_TEST_CASE(a_band_is_stable_within_one_window) {
  BOOST_TEST((is_stable(with_a_gap, 0.0, 2.58) && is_stable(with_a_gap, 3.2, 4.0)));
  BOOST_TEST(!is_stable(with_a_gap, 0.0, 2.6));
  BOOST_TEST(!is_stable(with_a_gap, 2.5, 3.2));  // the gap lies between
  BOOST_TEST(!is_stable(with_a_gap, 0.0, std::nan("")));
}

BOOST_AUTO_TEST_CASE(what_is_never_stable_has_no_window) {
  BOOST_TEST(chart_of("A", std::array{1.0}).windows.empty());
  const auto found = chart_of("AB", std::array{1.0, -1.0}).windows;
  BOOST_TEST((found.empty() || found.front().low > 0.0));
  for (const double wrong : {std::nan(""), infinite}) {
    BOOST_TEST(chart_of("BAB", std::array{0.5, wrong, 0.5}).windows.empty());
  }
}

// The last are wrong by a hundredth, without a gap, and with one too many.
BOOST_AUTO_TEST_CASE(windows_hold_everywhere_and_wrong_ones_do_not) {
  draws random;
  for (int n = 0; n < 3; ++n) {
    for (const auto& method : methods_as_data(random)) {
      if (method.letters().reads_modes) continue;
      BOOST_TEST_CONTEXT(method.name()) BOOST_TEST(first_wrong(stability_windows(method), method) == 0.0);
    }
  }
  const nysalt::method method = member(nystrom(), {0.5, 0.4});
  BOOST_TEST(first_wrong(with_a_gap, method) == 0.0);
  BOOST_TEST(first_wrong({with_a_gap[0], {again, 1.01 * last}}, method) > last);
  BOOST_TEST(first_wrong({{0.0, last}}, method) > end);
  BOOST_TEST(first_wrong({{0.0, 1.0}, {1.1, end}, with_a_gap[1]}, method) > 1.0);
}

BOOST_AUTO_TEST_CASE(letters_that_the_oscillator_lacks_are_refused) {
  BOOST_CHECK_THROW(chart_of("RSR", std::array{0.5, 1.0, 0.5}), std::invalid_argument);
  BOOST_CHECK_THROW(chart_of("S", std::array{1.0}), std::invalid_argument);
  BOOST_CHECK_THROW(chart_of("BAB", std::array{0.5, 1.0}), std::invalid_argument);
  BOOST_TEST(chart_of("OBABO", std::array{0.5, 0.5, 1.0, 0.5, 0.5}).windows.back().high == 2.0, nearly);
}

BOOST_AUTO_TEST_CASE(a_margin_is_the_share_to_the_end_of_the_window) {
  const auto near = tolerance(4.0 * eps);
  for (const double low : {0.0, 1.0}) BOOST_TEST(stability_margin(of_verlet, low, 1.5) == 0.25, near);
  BOOST_TEST(stability_margin(of_verlet, 0.0, 2.0) == 0.0);
  BOOST_TEST(stability_margin(of_verlet, 0.0, 0.0) == 1.0);
  for (const double low : {0.0, 2.5}) BOOST_TEST(stability_margin(of_verlet, low, 3.0) == -0.5, near);
  // In a later window both ends count, the nearer one most.
  const auto nearly_so = tolerance(8.0 * eps);
  BOOST_TEST(stability_margin(with_a_gap, 3.2, 3.3) == 1.0 - again / 3.2, nearly_so);
  BOOST_TEST(stability_margin(with_a_gap, 4.0, 4.05) == 1.0 - 4.05 / last, nearly_so);
  // From below the gap into the later window: unstable, by as much as it is beyond the first.
  BOOST_TEST(stability_margin(with_a_gap, 0.0, 3.5) == 1.0 - 3.5 / end, nearly_so);
  BOOST_TEST(stability_margin(with_a_gap, 2.9, 3.0) == 1.0 - 3.0 / end, nearly_so);
}

BOOST_AUTO_TEST_CASE(a_margin_is_negative_where_unstable_and_nowhere_else) {
  for (int i = 0; i <= 500; ++i) {
    for (const double width : {0.0, 0.3, 1.0}) {
      const double low = 0.01 * i;
      const bool stable = is_stable(with_a_gap, low, low + width);
      BOOST_TEST((stability_margin(with_a_gap, low, low + width) >= 0.0) == stable, low << " " << width);
    }
  }
  BOOST_TEST(stability_margin({}, 0.0, 1.0) == -infinite);
  BOOST_TEST(stability_margin({{1.0, 2.0}}, 0.5, 0.6) == -infinite);
  BOOST_TEST(stability_margin(of_verlet, 0.0, infinite) == -infinite);
}

BOOST_AUTO_TEST_CASE(stable_steps_are_those_of_all_bands) {
  const auto near = tolerance(4.0 * eps);
  const std::vector<frequency_band> apart{{0.0, 5.0}, {50.0, 51.0}};
  const auto steps = stable_steps(with_a_gap, apart);
  BOOST_REQUIRE(steps.size() == 2U);
  BOOST_TEST(steps[0].low == 0.0);
  BOOST_TEST(steps[0].high == end / 51.0, near);
  BOOST_TEST(steps[1].low == again / 50.0, near);
  BOOST_TEST(steps[1].high == last / 51.0, near);
  for (int i = 1; i < 1000; ++i) {
    const double h = 1e-4 * i;
    const bool claimed =
        std::any_of(steps.begin(), steps.end(), [h](const auto& s) { return s.low <= h && h <= s.high; });
    const bool stable = is_stable(with_a_gap, 0.0, 5.0 * h) && is_stable(with_a_gap, 50.0 * h, 51.0 * h);
    BOOST_TEST(claimed == stable, h);
  }
  // What has all frequencies up to the highest has none of the later window.
  BOOST_TEST(stable_steps(with_a_gap, {{0.0, 51.0}}).size() == 1U);
  // Nor what is too wide for it.
  BOOST_TEST(stable_steps(with_a_gap, {{30.0, 51.0}}).size() == 1U);
  BOOST_TEST(stable_steps({{1.0, 2.0}}, {{0.0, 1.0}}).empty());
  BOOST_TEST(stable_steps(of_verlet, {}).size() == 1U);
}

BOOST_AUTO_TEST_CASE(gaps_are_what_is_left_of_the_windows) {
  const auto are_gaps = [](double up_to, const std::vector<double>& expected) {
    std::vector<double> ends;
    for (const auto& [low, high] : detail::gaps_below(with_a_gap, up_to))
      ends.insert(ends.end(), {low, high});
    return ends == expected;
  };
  BOOST_TEST(are_gaps(2.5, {}));
  BOOST_TEST(are_gaps(3.0, {end, 3.0}));
  BOOST_TEST(are_gaps(5.0, {end, again, last, 5.0}));
  BOOST_TEST(detail::gaps_below({}, 1.0).size() == 1U);
}

// A step of phase t is n of phase t/n: cos t = +-1 at t = pi, ..., (n - 1) pi, and an Euler step of phase a
// has z = 2 sin(a/2). At an extremum trace/2 is flat, and z known to the square root of its rounding.
BOOST_AUTO_TEST_CASE(windows_touch_where_equal_steps_make_half_turns) {
  const auto near = tolerance(1e-6);
  for (const std::size_t n : {1U, 2U, 3U, 5U}) {
    const auto chart = chart_of_eulers(n);
    BOOST_REQUIRE(chart.touching.size() == n - 1);
    for (std::size_t k = 1; k < n; ++k) {
      const auto steps = static_cast<double>(n);
      const double expected = 2.0 * steps * std::sin(0.5 * std::numbers::pi * static_cast<double>(k) / steps);
      BOOST_TEST(chart.touching[k - 1] == expected, near);
    }
    BOOST_TEST(chart.windows.size() == 1U);
  }
  // The worst case for finding extrema.
  for (const std::size_t n : {8U, 9U, 12U, 16U, 20U, 32U, 64U}) {
    const auto windows = chart_of_eulers(n).windows;
    BOOST_TEST(windows.size() == 1U, n);
    BOOST_TEST(std::abs(windows.back().high - 2.0 * static_cast<double>(n)) < 1e-6, n);
  }
}

// Two half steps of Verlet touch at sqrt 8, and no other word of two stages; of three stages, that of BCSS.
BOOST_AUTO_TEST_CASE(a_gap_is_no_touch) {
  const auto two_stages = [](double b1, double beta1) {
    return chart_of("ABABA", nystrom::coefficients(std::array{b1, beta1}));
  };
  const auto halves = two_stages(0.5, 0.375);
  BOOST_REQUIRE(halves.touching.size() == 1U);
  BOOST_TEST(std::abs(halves.touching[0] - std::sqrt(8.0)) < 1e-7);
  BOOST_TEST(std::abs(halves.windows[0].high - 4.0) < 1e-7);
  BOOST_TEST(two_stages(0.5, 0.38).touching.empty());
  BOOST_TEST(two_stages(0.5, 0.4).windows.size() == 2U);
  const auto c = bcss3().coefficients();
  const auto of_bcss = chart_of("BABABAB", c);
  BOOST_REQUIRE(of_bcss.touching.size() == 1U);
  BOOST_TEST(of_bcss.touching[0] < of_bcss.windows[0].high);
  // A hundredth beside, and there is a gap.
  const double b = c[0] + 0.01;
  const auto beside = chart_of("BABABAB", std::array{b, c[1], 0.5 - b, c[3], 0.5 - b, c[1], b});
  BOOST_TEST(beside.touching.empty());
  BOOST_TEST(beside.windows[0].high < of_bcss.touching[0]);
}

BOOST_AUTO_TEST_CASE(a_strip_that_is_only_touched_is_not_left) {
  for (const int n : {2, 3, 6, 9, 12}) {
    // Twice the previous at each degree: rounding grows like that of 2^n terms.
    const double rounding = 4.0 * std::pow(2.0, n) * eps;
    BOOST_TEST(!detail::where_larger(chebyshev(n, -1.0, 1.0), 1.0 + rounding).has_value());
    BOOST_TEST(detail::where_larger(chebyshev(n, -1.0, 1.0), 1.0 - 1e-6).has_value());
    BOOST_TEST(detail::where_larger(chebyshev(n, -1.0, 1.001), 1.0 + rounding).value_or(0.0) > 1.0);
  }
}

// 1 + 1e-8 at x = 1/3, and below 1 but for 2e-4 around it.
BOOST_AUTO_TEST_CASE(the_narrowest_hump_is_found) {
  auto hump = -1.0 * with_roots(0.0, 1.0, {1.0 / 3.0, 1.0 / 3.0});
  hump += detail::bernstein_polynomial(0.0, 1.0, 1.0 + 1e-8);
  const auto x = detail::where_larger(hump, 1.0);
  BOOST_REQUIRE(x.has_value());
  BOOST_TEST(std::abs(*x - 1.0 / 3.0) <= 1e-4);
  BOOST_TEST(!detail::where_larger(hump, 1.0 + 1e-8 + eps).has_value());
}

// Chebyshev's polynomial of degree n turns n - 1 times, and its Bernstein coefficients alternate.
BOOST_AUTO_TEST_CASE(turns_are_counted) {
  for (const int n : {2, 3, 6, 9, 12}) {
    BOOST_TEST(chebyshev(n, -1.0, 1.0).turns(0.0) == n - 1);
    BOOST_TEST(chebyshev(n, 1.0, 2.0).turns(0.0) == 0);
  }
  auto rounded = detail::bernstein_polynomial(0.0, 1.0, 1.0);
  rounded += eps * chebyshev(6, 0.0, 1.0);
  BOOST_TEST(rounded.turns(1000.0 * eps) == 0);
  // Two roots of the derivative, 1/4 and 3/4, in one interval; one in each half.
  auto wave = 2.0 / 3.0 * with_roots(0.0, 1.0, {0.0, 0.0, 0.0});
  wave += -1.0 * with_roots(0.0, 1.0, {0.0, 0.0});
  wave += 0.375 * with_roots(0.0, 1.0, {0.0});
  BOOST_TEST(wave.turns(0.0) == 2);
  BOOST_TEST(wave.halves().first.turns(0.0) == 1);
  BOOST_TEST(wave.halves().second.turns(0.0) == 1);
}

BOOST_AUTO_TEST_CASE(what_is_no_number_is_within_nothing) {
  BOOST_TEST(detail::where_larger(detail::bernstein_polynomial(0.0, 1.0, not_a_number), 1e300).has_value());
  BOOST_TEST(detail::where_larger(with_roots(0.0, 1.0, {0.1, not_a_number, 0.2}), 1e300).has_value());
}
