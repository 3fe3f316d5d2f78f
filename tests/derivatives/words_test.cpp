// SPDX-License-Identifier: BSL-1.0
// Words: their orders by Taylor expansion are those that are declared, proved or published, and mistakes
// lower them; on oscillators, the matrix of a step, its energy error, its powers and its resonances.
#include "../laws/laws.hpp"
#include "../support/dense.hpp"
#include "../support/losses.hpp"
#include "../support/refusal.hpp"
#include "nysalt/core.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/derivatives/taylor_order.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

std::string in_words(const taylor_orders& orders) {
  return sentence("{} and {}", orders.quadratic_kinetic, orders.any_kinetic);
}
/// The order with a quadratic kinetic energy, and with any.
std::string orders(std::string_view letters, const std::vector<double>& coefficients) {
  return in_words(taylor_order(word(letters), coefficients));
}

/// Lengths of Verlet steps, composed so that the leading error vanishes: order n becomes n + 2
/// [hairer_lubich_wanner_2006, section II.4].
std::vector<double> triple_jump(const std::vector<double>& lengths, int n) {
  const double outer = 1.0 / (2.0 - std::pow(2.0, 1.0 / (n + 1.0)));
  std::vector<double> result;
  for (const double scale : {outer, 1.0 - 2.0 * outer, outer}) {
    for (const double length : lengths) result.push_back(scale * length);
  }
  return result;
}

taylor_orders of_verlet_steps(const std::vector<double>& lengths) {
  return detail::taylor_order_of(lengths, [](const auto& system, const auto& steps) {
    auto x = system.start();
    for (const double h : steps) make_stepper(system, verlet(), h).step(x);
    return x;
  });
}

/// P A(1/2) G(1, c) A(1/2) P^-1 where P = exp(h^2/24 [B, A]) up to h^4: the product of two commutators, of
/// flows over the times t and -t, t^2 = 1/48, whose terms of third order cancel.
taylor_orders order_in_other_coordinates(double c) {
  const double t = std::sqrt(1.0 / 48.0);
  const std::string forth = "BABABABA";
  const std::string back(forth.rbegin(), forth.rend());
  const std::vector<double> times{t, t, -t, -t, -t, -t, t, t};
  std::vector<double> all = times;
  for (const double of_kernel : {0.5, 1.0, c, 0.5}) all.push_back(of_kernel);
  for (auto time = times.rbegin(); time != times.rend(); ++time) all.push_back(-*time);
  return taylor_order(nysalt::word(forth + "AGA" + back), all);
}

constexpr double pi = std::numbers::pi;

method classical_word(std::string_view name) {
  std::vector<detail::classical_row> rows(std::begin(detail::classical_table),
                                          std::end(detail::classical_table));
  rows.insert(rows.end(), std::begin(detail::processed_table), std::end(detail::processed_table));
  return detail::as_data(*std::ranges::find(rows, name, &detail::classical_row::name));
}

double rho(const method& method, double z) {
  return detail::energy_error_on_oscillator(method.letters(), method.coefficients(), z);
}

/// The mean growth of (omega q)^2/2 + p^2/2 after n steps from independent normal omega q and p.
double growth(const method& method, double z, int steps) {
  const auto m = detail::matrix_on_oscillator(method.letters(), method.coefficients(), z * z);
  const Eigen::Matrix2d step{{m.qq, m.qp * z}, {m.pq / z, m.pp}};
  Eigen::Matrix2d power = Eigen::Matrix2d::Identity();
  for (int n = 0; n < steps; ++n) power = step * power;
  return 0.5 * (power.squaredNorm() - 2.0);
}

const std::vector<double> halves{0.5, 1.0, 0.5};

/// The largest norm of a power of the step, in coordinates scaled by the frequency.
double by_powers(const nysalt::word& word, const std::vector<double>& c, double theta, double k, int steps) {
  const auto times_k = [k](double x) { return k * x; };
  Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  for (const int i : {0, 1}) detail::step_on_oscillator(word, c, theta, times_k, one(0, i), one(1, i));
  const double omega = std::sqrt(theta * theta + k);
  one(0, 1) *= omega;
  one(1, 0) /= omega;
  Eigen::Matrix2d power = one;
  double largest = 1.0;
  for (int n = 1; n <= steps; ++n) {
    largest = std::max(largest, spectral_norm(power));
    power = one * power;
  }
  return largest;
}

const Eigen::Array2d omega(1.0, 2.2);
const Eigen::Matrix2d soft = 0.05 * Eigen::Matrix2d{{1.0, 0.8}, {0.8, 1.0}};

with_quadratic_part<linear_chain> two_modes(const Eigen::Matrix2d& rest) {
  const Eigen::Matrix2d squares = omega.square().matrix().asDiagonal();
  return {linear_chain(squares + rest), squares};
}

/// Logarithm of the spectral radius of the matrix of one step.
double growth_of_step(const auto& system, const nysalt::word& word, const std::vector<double>& c, double h) {
  const method method("a step", word, c, {1, false, false});
  const phase_point<double, Eigen::Dynamic> anywhere{Eigen::Vector2d(0.1, 0.2), Eigen::Vector2d(0.3, 0.1)};
  return std::log(spectral_radius(detail::jacobian(detail::step_map(system, method, h), anywhere)));
}

std::optional<detail::resonance> near(const method& method, const std::vector<frequency_band>& bands,
                                      double step) {
  return detail::near_resonance(method.letters(), method.coefficients(), bands, step);
}

/// Position Verlet in that many equal steps, whose phase at z is 2 n asin(z/(2 n)).
method many_steps(int n) {
  std::string letters = "A";
  std::vector<double> c{0.5 / n};
  for (int k = 0; k < n; ++k) {
    letters += "BA";
    c.push_back(1.0 / n);
    c.push_back(k + 1 < n ? 1.0 / n : 0.5 / n);
  }
  return {"verlet", nysalt::word(letters), c, {2, true, false}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(methods_have_the_order_that_they_declare) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    // At a fixed z these have the order 2; their own is that of h -> 0 at a fixed frequency
    // (adaptive_test.cpp).
    if (method.name().starts_with("phase_fitted")) continue;
    const auto found = taylor_order(method);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
      BOOST_TEST(found.quadratic_kinetic == method.order);
      if (!method.requires_quadratic_kinetic) BOOST_TEST(found.any_kinetic == method.order);
      // Letters other than drifts and kicks need it themselves, whatever the order.
      const bool of_drifts_and_kicks = method.letters().letters().find_first_of("GRSH") == std::string::npos;
      if (method.requires_quadratic_kinetic && of_drifts_and_kicks) {
        BOOST_TEST(found.any_kinetic < method.order);
      }
    }
  }
}

// A change of coordinates makes a method of order 4 of Takahashi and Imada's, not of Verlet's, or with
// another c.
BOOST_AUTO_TEST_CASE(effective_orders) {
  const auto order_with = [](double c) { return order_in_other_coordinates(c).quadratic_kinetic; };
  BOOST_TEST(order_with(takahashi_imada().coefficients()[2]) == 4);
  BOOST_TEST(order_with(0.0) == 2);
  BOOST_TEST(order_with(1.0 / 25.0) == 2);
}

BOOST_AUTO_TEST_CASE(low_orders) {
  BOOST_TEST(orders("BA", {1.0, 1.0}) == "1 and 1");
  BOOST_TEST(orders("BA", {1.0, 0.9}) == "0 and 0");
  BOOST_TEST(orders("A", {1.0}) == "0 and 0");
}

// Compositions of any kind, with coefficients known at run time; and high orders, where terms cancel that are
// far larger than their sum.
BOOST_AUTO_TEST_CASE(triple_jumps_gain_two_orders_each) {
  std::vector<double> lengths{1.0};
  for (const int order : {2, 4, 6, 8}) {
    BOOST_TEST(in_words(of_verlet_steps(lengths)) == in_words(taylor_orders{order, order}));
    lengths = triple_jump(lengths, order);
  }
}

BOOST_AUTO_TEST_CASE(the_highest_order_means_this_or_more) {
  const auto exact = [](const auto& system, const auto&) { return system.flow(); };
  const int highest = detail::highest_taylor_order;
  BOOST_TEST(in_words(detail::taylor_order_of({1.0}, exact)) == in_words(taylor_orders{highest, highest}));
}

// A slip in the sixth decimal: the order that is left depends on what the slip spares.
BOOST_AUTO_TEST_CASE(a_wrong_digit_lowers_the_order) {
  const double slip = 1e-6;
  const std::string letters = srkn11b().letters().letters();
  auto c = srkn11b().coefficients();
  c[3] += slip;  // the drifts no longer add up to 1
  BOOST_TEST(orders(letters, c) == "0 and 0");
  c[9] -= slip;  // they do, but the word is not symmetric
  BOOST_TEST(orders(letters, c) == "1 and 1");
  c[19] += slip;
  c[13] -= slip;  // it is again, and of even order
  BOOST_TEST(orders(letters, c) == "2 and 2");
}

// The coefficients of a method that is not symmetric, from the other letter on, are another method.
BOOST_AUTO_TEST_CASE(the_letter_that_comes_first_matters) {
  auto c = mclachlan_atela4().coefficients();
  BOOST_TEST(orders("ABABABAB", c) == "3 and 3");
  std::reverse(c.begin(), c.end());  // the adjoint
  BOOST_TEST(orders("ABABABAB", c) == "4 and 3");
}

// As in a table of ten or more digits.
BOOST_AUTO_TEST_CASE(rounded_tables_keep_their_order) {
  const auto orders_of_rounded = [](const method& method, double digits) {
    auto coefficients = method.coefficients();
    for (double& c : coefficients) c = std::round(c * digits) / digits;
    return in_words(taylor_order(method.letters(), coefficients));
  };
  for (const double digits : {1e10, 1e12, 1e14}) {
    BOOST_TEST(orders_of_rounded(srkn11b(), digits) == "6 and 4");
    BOOST_TEST(orders_of_rounded(srkn14a(), digits) == "6 and 4");
  }
  BOOST_TEST(orders_of_rounded(srkn11b(), 1e7) == "0 and 0");
}

BOOST_AUTO_TEST_CASE(what_is_no_number_is_not_consistent) {
  using limits = std::numeric_limits<double>;
  for (const double wrong : {limits::quiet_NaN(), limits::infinity(), limits::max()}) {
    BOOST_TEST(orders("BAB", {0.5, wrong, 0.5}) == "0 and 0");
    BOOST_TEST(orders("BAB", {wrong, 1.0, -wrong}) == "0 and 0");
  }
}

// On the oscillator this one has order 6 (see methods/laws_test.cpp).
BOOST_AUTO_TEST_CASE(an_accident_on_the_oscillator_does_not_count) {
  const auto c = detail::palindrome<11>({0.18685656311551122, 0.5642486163110636,  //
                                         0.5520581660514783, -0.23936270217732913});
  BOOST_TEST(orders("BABABABABAB", {c.begin(), c.end()}) == "4 and 4");
}

// Velocity Verlet: trace/2 = 1 - x/2 with x = z^2; Takahashi and Imada's has x^2/24 more. Impulses: cos theta
// - k sin(theta)/(2 theta). The bath is left out.
BOOST_AUTO_TEST_CASE(traces_are_the_known_ones) {
  const auto are = [](const char* letters, const std::vector<double>& c, double theta, double low,
                      double high, double at_low, double at_high) {
    const auto trace = detail::half_trace(nysalt::word(letters), c, theta, low, high);
    BOOST_TEST(std::abs(trace.at_low() - at_low) < 10.0 * eps, letters);
    BOOST_TEST(std::abs(trace.at_high() - at_high) < 100.0 * eps, letters);
  };
  are("BAB", halves, 0.0, 1.0, 9.0, 0.5, -3.5);
  are("BAOAB", {0.5, 0.5, 1.0, 0.5, 0.5}, 0.0, 1.0, 9.0, 0.5, -3.5);
  are("AGA", {0.5, 1.0, 1.0 / 24.0, 0.5}, 0.0, 1.0, 4.0, 0.5 + 1.0 / 24.0, -1.0 + 16.0 / 24.0);
  are("SRS", halves, 2.0, 0.0, 3.0, std::cos(2.0), std::cos(2.0) - 0.75 * std::sin(2.0));
}

// After n steps the energy has grown by sin^2(n t) rho, cos t = trace/2. The matrix errs by some 10 roundings
// of its entries, which are below z + 1/z here, and its n-th power by n times that.
BOOST_AUTO_TEST_CASE(the_energy_grows_by_rho_times_the_square_of_a_sine) {
  for (const char* name : {"verlet", "mclachlan2", "mclachlan2v", "bcss3", "bcss4", "omelyan5v", "srkn6b",
                           "chin4a", "chin4a_displaced"}) {
    const nysalt::method method = classical_word(name);
    for (const double z : {0.3, 0.9, 1.5}) {
      const auto m = detail::matrix_on_oscillator(method.letters(), method.coefficients(), z * z);
      const double angle = std::acos(m.half_trace());
      for (const int steps : {1, 2, 7}) {
        const double sine = std::sin(steps * angle);
        const double expected = sine * sine * rho(method, z);
        const double rounding = 2.0 * steps * 10.0 * eps * (z + 1.0 / z) * (z + 1.0 / z);
        BOOST_TEST_CONTEXT(name << " at z = " << z << ", " << steps << " steps") {
          BOOST_TEST(std::abs(growth(method, z, steps) - expected) <= rounding);
          BOOST_TEST(std::abs(growth(method, z, steps) - 1.01 * expected) > 1e-3 * expected);
        }
      }
    }
  }
}

// Against a central difference over 1e-5, which errs by the third derivative, of order one, times 1e-10/6,
// and by roundings of 1e-15 over 1e-5.
BOOST_AUTO_TEST_CASE(slopes_are_those_of_the_value) {
  draws random;
  for (const char* name : {"mclachlan2v", "bcss3", "chin4a", "chin4a_displaced"}) {
    const nysalt::method method = classical_word(name);
    const double z = random.uniform(0.7, 1.3);
    const auto c = method.coefficients();
    const auto at = detail::energy_defect_on_oscillator(method.letters(), c, z);
    BOOST_TEST(at.value * at.value == rho(method, z), tolerance(1e-12));
    for (std::size_t i = 0; i < c.size(); ++i) {
      const auto defect = [&](const auto& at) {
        return detail::energy_defect_on_oscillator(method.letters(), at, z).value;
      };
      const double found = central_difference(defect, c, i)(1e-5);
      const double slope = at.slopes[static_cast<Eigen::Index>(i)];
      BOOST_TEST(std::abs(found - slope) <= 1e-8 * (1.0 + std::abs(slope)),
                 name << ", coefficient " << i + 1);
    }
  }
}

BOOST_AUTO_TEST_CASE(beyond_the_window_it_is_infinite_and_words_that_are_no_plain_step_are_refused) {
  for (const double beyond : {2.0, 2.01}) BOOST_TEST(std::isinf(rho(method(verlet{}), beyond)));
  for (const char* name : {"impulse", "baoab", "takahashi_imada_processed"}) {
    BOOST_TEST(refuses([&] { rho(classical_word(name), 0.5); }, {"no rotation", "no processor"}));
  }
  BOOST_TEST(refuses([] { detail::energy_error_on_oscillator(nysalt::word("BAB"), {0.5, 1.0}, 0.5); }, {}));
}

// The formula lets n t come to pi/2, which some n of 200 do to within a few degrees.
BOOST_AUTO_TEST_CASE(it_is_that_of_all_powers) {
  draws random;
  int unstable = 0;
  for (int n = 0; n < 300; ++n) {
    const double theta = n % 5 == 0 ? 0.0 : random.uniform(0.1, 7.0);
    const double k = random.uniform(0.01, 4.0);
    const double expected = by_powers(nysalt::word("RSR"), halves, theta, k, 200);
    const double found = detail::transient_growth(nysalt::word("RSR"), halves, theta, k, 200);
    if (expected > 1e6) ++unstable;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", theta " << theta << ", k " << k) {
      if (expected < 1e6) BOOST_TEST(std::abs(found - expected) <= 0.05 * expected);
      if (expected >= 1e6) BOOST_TEST(found > 1e5);
    }
  }
  BOOST_TEST(unstable > 10);
}

// S R S at h omega = pi is -(1, 0; k, 1) in (q, p): g = n k/omega beside the diagonal after n steps, with
// omega^2 = pi^2 + k, and the norm g/2 + sqrt(1 + g^2/4).
BOOST_AUTO_TEST_CASE(impulses_grow_linearly_at_a_resonance) {
  const double k = 0.09;
  const double per_step = k / std::sqrt(pi * pi + k);
  for (const std::int64_t steps : {1000, 10'000}) {
    const double found = detail::transient_growth(nysalt::word("SRS"), {0.5, 1.0, 0.5}, pi, k, steps);
    const double g = per_step * static_cast<double>(steps);
    // Rounding of pi makes t some 2e-9, and the error (n t)^2.
    BOOST_TEST(std::abs(found / (0.5 * g + std::sqrt(1.0 + 0.25 * g * g)) - 1.0) < 1e-8);
  }
  BOOST_TEST(detail::transient_growth(nysalt::word("RSR"), halves, 0.9 * pi, k, 10'000) < 1.1);
}

BOOST_AUTO_TEST_CASE(what_is_exact_magnifies_nothing_and_what_is_no_number_is_not_within_a_bound) {
  BOOST_TEST(detail::transient_growth(nysalt::word("R"), {1.0}, 2.0, 1e-30, 10'000) <= 1.0 + 1e-9);
  BOOST_TEST(
      !(detail::transient_growth(nysalt::word("RSR"), {0.5, std::nan(""), 0.5}, 2.0, 0.1, 100) <= 1e300));
}

BOOST_AUTO_TEST_CASE(growth_is_that_of_the_eigenvalues_of_a_step) {
  draws random;
  int growing = 0;
  for (const char* letters : {"SRS", "RSRSR", "SRHRS"}) {
    const nysalt::word word{std::string(letters)};
    for (int n = 0; n < 200; ++n) {
      std::vector<double> c(word.slots, 0.5);
      if (word.slots == 3) c[1] = 1.0;
      if (word.slots == 6) c = {0.25, 0.5, 0.5, 0.01, 0.5, 0.25};
      const double h = random.uniform(0.1, 4.0);
      const Eigen::Matrix2d k = random.uniform(0.1, 3.0) * soft;
      const auto system = two_modes(k);
      const double expected = growth_of_step(system, word, c, h);
      const double found = detail::growth_of_pair(word, c, h * omega, h * h * k);
      // Eigenvalues of a defective matrix err by the root of rounding, times entries of some tens.
      BOOST_TEST(std::abs(found - expected) < 1e-6,
                 letters << " at " << h << ": " << found << ", " << expected);
      growing += expected > 1e-3;
    }
  }
  BOOST_TEST(growing > 10);
  // At a difference resonance there is nothing.
  const double h = 2.0 * pi / (omega[1] - omega[0]);
  BOOST_TEST(detail::growth_of_pair(nysalt::word("SRS"), halves, h * omega, h * h * soft) < 1e-6);
}

// Sixty-four steps turn by z to within z^3/(24 n^2), 0.3 % at 2 pi.
BOOST_AUTO_TEST_CASE(near_means_within_a_tenth_of_the_half_turns) {
  const nysalt::method method = many_steps(64);
  for (const int k : {1, 2}) {
    for (const double off : {-0.12, -0.09, -0.05, 0.0, 0.05, 0.09, 0.12}) {
      const double step = (1.0 + off) * k * pi / 50.0;
      const auto found = near(method, {{0.0, 6.0}, {50.0, 50.0}}, step);
      BOOST_TEST(found.has_value() == (std::abs(off) < 0.1), k << " pi, off by " << off);
      if (found) BOOST_TEST(found->half_turns == k);
    }
  }
}

// What counts is the phase of the word: Verlet in two steps turns by 3.6 where h omega is pi: the step of
// another motion, as that of one Verlet step of half the length. Slow motion and rotations have none.
BOOST_AUTO_TEST_CASE(a_band_is_near_where_one_of_its_frequencies_is) {
  const nysalt::method method = many_steps(64);
  BOOST_TEST(near(method, {{40.0, 50.0}}, 0.95 * pi / 40.0).has_value());
  BOOST_TEST(near(method, {{40.0, 50.0}}, 0.95 * pi / 50.0).has_value());
  BOOST_TEST(!near(method, {{40.0, 50.0}}, 0.85 * pi / 50.0));
  BOOST_TEST(near(method, {{50.0, 50.0}}, pi / 50.0).has_value());
  BOOST_TEST(!near(many_steps(2), {{50.0, 50.0}}, pi / 50.0));
  BOOST_TEST(!near(method, {{0.0, 30.0}}, pi / 30.0));
  BOOST_TEST(!near(method, {{49.0, 51.0}}, 0.01));
  BOOST_TEST(!near(method, {}, 1.0));
  BOOST_TEST(!near(nysalt::method(impulse{}), {{50.0, 50.0}}, pi / 50.0));
}

BOOST_AUTO_TEST_CASE(in_words_it_says_which) {
  const std::string text = detail::in_words(*near(many_steps(64), {{49.0, 51.0}}, 0.118));
  for (const char* words : {"2 pi", "10 %", "49 to 51"})
    BOOST_TEST(text.find(words) != std::string::npos, text);
}
