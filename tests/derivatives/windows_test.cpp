// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 49 s at -O0, 1.2 s at -O1.
// Stability windows: their known ends, an oracle by eigenvalues, and what steps and long runs do on either
// side of an end; margins, stable steps and touching windows in closed form; and the Bernstein polynomials
// that enclose trace/2.
#include "../laws/laws.hpp"
#include "../support/dense.hpp"
#include "nysalt/core.hpp"
#include "nysalt/derivatives/bernstein.hpp"
#include "nysalt/derivatives/jacobian.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/stability_margin.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The oscillator of frequency 1, so that z is the step.
const harmonic_oscillator& unit_oscillator() {
  static const harmonic_oscillator system(1.0);
  return system;
}

phase_point<double, 1> at_one() { return {vector<double, 1>(1.0), vector<double, 1>(1.0)}; }

/// The eigenvalues' largest absolute value, from the exact Jacobian of a step.
template <Method M>
double spectral_radius(const M& method, double z) {
  const Eigen::MatrixXd step = jacobian(step_map(unit_oscillator(), method, z), at_one());
  return test::spectral_radius(step);
}

/// What rounding may add to it where the eigenvalues are apart: the determinant, 1, is their squared size,
/// and errs by 2 |J| |dJ|. Letter k rounds the product P_k so far, by 2 eps |L_k| |P_k|, and the letters
/// after it carry that on.
template <Method M>
double radius_rounding(const M& method, double z) {
  const auto word = word_of(method);
  const std::string letters = word.letters();
  const auto c = method.coefficients();
  std::vector<Eigen::Matrix2d> so_far;
  std::vector<Eigen::Matrix2d> letter(letters.size(), Eigen::Matrix2d::Identity());
  Eigen::Matrix2d product = Eigen::Matrix2d::Identity();
  for (std::size_t k = 0; k < letters.size(); ++k) {
    const std::size_t slot = word.first_slot(k);
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

/// Largest coordinate over 100,000 steps, or where it first exceeds 1e9. (Not by integrate: near the ends of
/// a window bounded orbits swing by more than its criterion for divergence.)
template <Method M>
double largest_in_long_run(const M& method, double z) {
  const auto fixed = make_stepper(unit_oscillator(), method, z);
  auto run = fixed.open(at_one());
  double largest = 0.0;
  while (run.step < 100'000 && largest <= 1e9) {
    fixed.advance(run, 1);
    largest = std::max(largest, size_of(fixed.synchronous(run)));
  }
  return largest;
}

/// What it may be inside a window: with trace/2 = cos t, J^n = cos(n t) + sin(n t)/sin(t) (J - cos t).
/// Twice that, as rounding moves t by a little.
template <Method M>
double bound_of_long_run(const M& method, double z) {
  const Eigen::Matrix2d step = jacobian(step_map(unit_oscillator(), method, z), at_one());
  const double cosine = 0.5 * step.trace();
  return 2.0 * (1.0 + norm(step - cosine * Eigen::Matrix2d::Identity()) / std::sqrt(1.0 - cosine * cosine));
}

/// Calls inside(z) and outside(z) near the ends of every window: so large a part of the narrowest width or
/// gap beside the end away from it. A window that begins at 0 has no outside there. Far out letters magnify
/// so much that rounding hides where a window ends: those are left out, but never the first.
template <Method M>
void try_ends(const M& method, double part_inside, double part_outside, auto&& inside, auto&& outside) {
  const auto windows = stability_windows(method);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto [low, high] = windows[i];
    if (i > 0 && radius_rounding(method, high) > 1e-6) continue;
    double nearest = high - low;
    if (i > 0) nearest = std::min(nearest, low - windows[i - 1].high);
    if (i + 1 < windows.size()) nearest = std::min(nearest, windows[i + 1].low - high);
    BOOST_TEST_CONTEXT("window " << low << ".." << high) {
      inside(high - part_inside * nearest);
      outside(high + part_outside * nearest);
      inside(low + part_inside * nearest);
      if (low > 0.0) outside(low - part_outside * nearest);
    }
  }
}

const std::vector<stability_window> of_verlet{{0.0, 2.0}};
/// Of the two-stage word (1/2, 2/5).
const double end = std::sqrt(20.0 / 3.0);
const double again = std::sqrt(10.0);
const double last = std::sqrt(50.0 / 3.0);
const std::vector<stability_window> with_a_gap{{0.0, end}, {again, last}};

auto windows_at(double b1, double beta1) {
  return stability_windows(tabulated(member<nystrom>({b1, beta1})));
}
stability_chart chart_of(const std::string& letters, const auto& c) {
  return chart_stability(run_time_word(letters), {c.begin(), c.end()});
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
  const auto one = make_stepper(system, method, 1.0);
  const auto stepped = [&](double q, double p) {
    auto x = phase_point<double, 1>{vector<double, 1>(q), vector<double, 1>(p)}.cast<polynomial>();
    one.step(x);
    return x;
  };
  return (stepped(1.0, 0.0).q[0] + stepped(0.0, 1.0).p[0]) * 0.5;
}

/// Positive z where trace/2 passes +-1, by the eigenvalues of companion matrices: an oracle that has nothing
/// in common with what finds the windows. Complex roots with a small imaginary part are left out.
std::vector<double> ends_by_eigenvalues(const tabulated& method) {
  std::vector<double> ends;
  for (const double y : {-1.0, 1.0}) {
    const auto all = (half_trace_of(method) - polynomial(y)).coefficient;
    std::vector<double> c(all.begin() + (y > 0.0 ? 1 : 0), all.end());  // x = 0 is no end
    const double largest = Eigen::Map<Eigen::VectorXd>(c.data(), std::ssize(c)).cwiseAbs().maxCoeff();
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
  BOOST_TEST(windows[0].high == with_a_gap[0].high, nearly);
  BOOST_TEST(windows[1].low == with_a_gap[1].low, nearly);
  BOOST_TEST(windows[1].high == with_a_gap[1].high, nearly);
  // Between the windows: a claim that they are one must fail.
  const tabulated method(member<nystrom>({0.5, 0.4}));
  BOOST_TEST(spectral_radius(method, 2.5) <= 1.0 + radius_rounding(method, 2.5));
  BOOST_TEST(spectral_radius(method, 2.9) > 1.1);
  BOOST_TEST(spectral_radius(method, 3.5) <= 1.0 + radius_rounding(method, 3.5));
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
  for (const double limit : {stability_limit(verlet()), stability_limit(verlet_aba()),
                             stability_limit(member<nystrom>({0.5, 0.5}))})
    BOOST_TEST(limit == 2.0, nearly);
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
  const auto a = chart_of("ABABA", bcss2::coefficients()).windows;
  const auto b = chart_of("BABAB", bcss2::coefficients()).windows;
  BOOST_REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    BOOST_TEST(a[i].low == b[i].low, nearly);
    BOOST_TEST(a[i].high == b[i].high, nearly);
  }
  BOOST_TEST(std::abs(a[0].high - stability_limit(mclachlan2())) > 1e-3);
}

BOOST_AUTO_TEST_CASE(a_band_is_stable_within_one_window) {
  const auto& windows = with_a_gap;
  BOOST_TEST(is_stable(windows, 0.0, 2.58));
  BOOST_TEST(is_stable(windows, 3.2, 4.0));
  BOOST_TEST(!is_stable(windows, 0.0, 2.6));
  BOOST_TEST(!is_stable(windows, 2.5, 3.2));  // the gap lies between
  BOOST_TEST(!is_stable(windows, 0.0, std::nan("")));
}

BOOST_AUTO_TEST_CASE(what_is_never_stable_has_no_window) {
  BOOST_TEST(chart_of("A", std::array{1.0}).windows.empty());
  const auto windows = chart_of("AB", std::array{1.0, -1.0}).windows;
  BOOST_TEST((windows.empty() || windows.front().low > 0.0));
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    BOOST_TEST(chart_of("BAB", std::array{0.5, wrong, 0.5}).windows.empty());
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
  BOOST_CHECK_THROW(chart_of("RSR", std::array{0.5, 1.0, 0.5}), error);
  BOOST_CHECK_THROW(chart_of("S", std::array{1.0}), error);
  BOOST_CHECK_THROW(chart_of("BAB", std::array{0.5, 1.0}), error);
  BOOST_TEST(chart_of("OBABO", std::array{0.5, 0.5, 1.0, 0.5, 0.5}).windows.back().high == 2.0, nearly);
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

namespace {

using boost::test_tools::tolerance;

/// n steps of symplectic Euler, each 1/n of the whole.
stability_chart chart_of_eulers(std::size_t n) {
  std::string letters;
  for (std::size_t i = 0; i < n; ++i) letters += "AB";
  return chart_of(letters, std::vector<double>(2 * n, 1.0 / static_cast<double>(n)));
}

/// (x - r_1) (x - r_2) ... on low..high.
bernstein_polynomial with_roots(double low, double high, const std::vector<double>& roots) {
  bernstein_polynomial product(low, high, 1.0);
  for (const double r : roots) {
    auto next = product.times_x();
    next += -r * product;
    product = next;
  }
  return product;
}

/// Chebyshev's polynomial of degree n on -1..1, between -1 and 1, which it takes n + 1 times.
bernstein_polynomial chebyshev(int n, double low, double high) {
  bernstein_polynomial before(low, high, 1.0);
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

BOOST_AUTO_TEST_CASE(a_margin_is_the_share_to_the_end_of_the_window) {
  const auto near = tolerance(4.0 * eps);
  for (const double low : {0.0, 1.0}) BOOST_TEST(stability_margin(of_verlet, low, 1.5) == 0.25, near);
  BOOST_TEST(stability_margin(of_verlet, 0.0, 2.0) == 0.0);
  BOOST_TEST(stability_margin(of_verlet, 0.0, 0.0) == 1.0);
  for (const double low : {0.0, 2.5}) BOOST_TEST(stability_margin(of_verlet, low, 3.0) == -0.5, near);
}

// In a later window both ends count, the nearer one most.
BOOST_AUTO_TEST_CASE(a_gap_below_is_an_end_too) {
  const auto near = tolerance(8.0 * eps);
  BOOST_TEST(stability_margin(with_a_gap, 3.2, 3.3) == 1.0 - again / 3.2, near);
  BOOST_TEST(stability_margin(with_a_gap, 4.0, 4.05) == 1.0 - 4.05 / last, near);
  // From below the gap into the later window: unstable, by as much as it is beyond the first.
  BOOST_TEST(stability_margin(with_a_gap, 0.0, 3.5) == 1.0 - 3.5 / end, near);
  BOOST_TEST(stability_margin(with_a_gap, 2.9, 3.0) == 1.0 - 3.0 / end, near);
}

BOOST_AUTO_TEST_CASE(it_is_negative_where_unstable_and_nowhere_else) {
  for (int i = 0; i <= 500; ++i) {
    for (const double width : {0.0, 0.3, 1.0}) {
      const double low = 0.01 * i;
      const bool stable = is_stable(with_a_gap, low, low + width);
      BOOST_TEST((stability_margin(with_a_gap, low, low + width) >= 0.0) == stable, low << " " << width);
    }
  }
  const double nothing = -std::numeric_limits<double>::infinity();
  BOOST_TEST(stability_margin({}, 0.0, 1.0) == nothing);
  BOOST_TEST(stability_margin({{1.0, 2.0}}, 0.5, 0.6) == nothing);
  BOOST_TEST(stability_margin(of_verlet, 0.0, std::numeric_limits<double>::infinity()) == nothing);
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
    for (const auto& [low, high] : gaps_below(with_a_gap, up_to)) ends.insert(ends.end(), {low, high});
    return ends == expected;
  };
  BOOST_TEST(are_gaps(2.5, {}));
  BOOST_TEST(are_gaps(3.0, {end, 3.0}));
  BOOST_TEST(are_gaps(5.0, {end, again, last, 5.0}));
  BOOST_TEST(gaps_below({}, 1.0).size() == 1U);
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

BOOST_AUTO_TEST_CASE(values_at_the_ends_of_all_halves_are_those_of_the_product) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    std::vector<double> roots;
    for (int k = 0; k < 6; ++k) roots.push_back(random.uniform(-1.0, 4.0));
    auto f = with_roots(0.5, 3.0, roots);
    for (int depth = 0; depth < 5; ++depth) {
      double expected = 1.0;
      for (const double r : roots) expected *= f.high() - r;
      // 6 factors of a size up to 4 each, 6 roundings of each, and halves that round once each.
      BOOST_TEST(std::abs(f.at_high() - expected) <= 40.0 * eps * std::pow(4.0, 6.0));
      BOOST_TEST(f.bounds().first <= f.at_low());
      BOOST_TEST(f.bounds().second >= f.at_high());
      auto [lower, upper] = f.halves();
      BOOST_TEST(lower.high() == upper.low());
      BOOST_TEST(lower.at_high() == upper.at_low());
      f = depth % 2 == 0 ? lower : upper;
    }
  }
}

BOOST_AUTO_TEST_CASE(a_strip_that_is_only_touched_is_not_left) {
  for (const int n : {2, 3, 6, 9, 12}) {
    // Twice the previous at each degree: rounding grows like that of 2^n terms.
    const double rounding = 4.0 * std::pow(2.0, n) * eps;
    BOOST_TEST(!where_larger(chebyshev(n, -1.0, 1.0), 1.0 + rounding).has_value());
    BOOST_TEST(where_larger(chebyshev(n, -1.0, 1.0), 1.0 - 1e-6).has_value());
    BOOST_TEST(where_larger(chebyshev(n, -1.0, 1.001), 1.0 + rounding).value_or(0.0) > 1.0);
  }
}

// 1 + 1e-8 at x = 1/3, and below 1 but for 2e-4 around it.
BOOST_AUTO_TEST_CASE(the_narrowest_hump_is_found) {
  auto hump = -1.0 * with_roots(0.0, 1.0, {1.0 / 3.0, 1.0 / 3.0});
  hump += bernstein_polynomial(0.0, 1.0, 1.0 + 1e-8);
  const auto x = where_larger(hump, 1.0);
  BOOST_REQUIRE(x.has_value());
  BOOST_TEST(std::abs(*x - 1.0 / 3.0) <= 1e-4);
  BOOST_TEST(!where_larger(hump, 1.0 + 1e-8 + eps).has_value());
}

// Chebyshev's polynomial of degree n turns n - 1 times, and its Bernstein coefficients alternate.
BOOST_AUTO_TEST_CASE(turns_are_counted) {
  for (const int n : {2, 3, 6, 9, 12}) {
    BOOST_TEST(chebyshev(n, -1.0, 1.0).turns(0.0) == n - 1);
    BOOST_TEST(chebyshev(n, 1.0, 2.0).turns(0.0) == 0);
  }
  auto rounded = bernstein_polynomial(0.0, 1.0, 1.0);
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
  const double nan = std::nan("");
  BOOST_TEST(where_larger(bernstein_polynomial(0.0, 1.0, nan), 1e300).has_value());
  BOOST_TEST(where_larger(with_roots(0.0, 1.0, {0.1, nan, 0.2}), 1e300).has_value());
}
