// SPDX-License-Identifier: BSL-1.0
// Orders by Taylor expansion are those that are declared, proved or published, and mistakes lower them.
#include "../laws/laws.hpp"
#include "nysalt/core.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

std::string in_words(const taylor_orders& orders) {
  return sentence("{} and {}", orders.quadratic_kinetic, orders.any_kinetic);
}
/// The order with a quadratic kinetic energy, and with any.
std::string orders(const auto&... of) { return in_words(taylor_order(of...)); }

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
  return taylor_order_of(lengths, [](const auto& system, const auto& steps) {
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
  return taylor_order(run_time_word(forth + "AGA" + back), all);
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
  BOOST_TEST(order_with(takahashi_imada::coefficients()[2]) == 4);
  BOOST_TEST(order_with(0.0) == 2);
  BOOST_TEST(order_with(1.0 / 25.0) == 2);
}

BOOST_AUTO_TEST_CASE(low_orders) {
  using symplectic_euler = word<kick, drift>;
  BOOST_TEST(orders(symplectic_euler{}, std::array{1.0, 1.0}) == "1 and 1");
  BOOST_TEST(orders(symplectic_euler{}, std::array{1.0, 0.9}) == "0 and 0");
  BOOST_TEST(orders(word<drift>{}, std::array{1.0}) == "0 and 0");
}

// Compositions of any kind, with coefficients known at run time; and high orders, where terms cancel that are
// far larger than their sum.
BOOST_AUTO_TEST_CASE(triple_jumps_gain_two_orders_each) {
  std::vector<double> lengths{1.0};
  for (const int order : {2, 4, 6, 8}) {
    BOOST_TEST(in_words(of_verlet_steps(lengths)) == in_words({order, order}));
    lengths = triple_jump(lengths, order);
  }
}

BOOST_AUTO_TEST_CASE(the_highest_order_means_this_or_more) {
  const auto exact = [](const auto& system, const auto&) { return system.flow(); };
  const int highest = highest_taylor_order;
  BOOST_TEST(in_words(taylor_order_of(std::array{1.0}, exact)) == in_words({highest, highest}));
}

// A slip in the sixth decimal: the order that is left depends on what the slip spares.
BOOST_AUTO_TEST_CASE(a_wrong_digit_lowers_the_order) {
  const double slip = 1e-6;
  auto c = srkn11b::coefficients();
  c[3] += slip;  // the drifts no longer add up to 1
  BOOST_TEST(orders(srkn11b::word{}, c) == "0 and 0");
  c[9] -= slip;  // they do, but the word is not symmetric
  BOOST_TEST(orders(srkn11b::word{}, c) == "1 and 1");
  c[19] += slip;
  c[13] -= slip;  // it is again, and of even order
  BOOST_TEST(orders(srkn11b::word{}, c) == "2 and 2");
}

// The coefficients of a method that is not symmetric, from the other letter on, are another method.
BOOST_AUTO_TEST_CASE(the_letter_that_comes_first_matters) {
  using drift_first = word<drift, kick, drift, kick, drift, kick, drift, kick>;
  auto c = mclachlan_atela4::coefficients();
  BOOST_TEST(orders(drift_first{}, c) == "3 and 3");
  std::reverse(c.begin(), c.end());  // the adjoint
  BOOST_TEST(orders(drift_first{}, c) == "4 and 3");
}

// As in a table of ten or more digits.
BOOST_AUTO_TEST_CASE(rounded_tables_keep_their_order) {
  const auto rounded = [](auto coefficients, double digits) {
    for (double& c : coefficients) c = std::round(c * digits) / digits;
    return coefficients;
  };
  for (const double digits : {1e10, 1e12, 1e14}) {
    BOOST_TEST(orders(srkn11b::word{}, rounded(srkn11b::coefficients(), digits)) == "6 and 4");
    BOOST_TEST(orders(srkn14a::word{}, rounded(srkn14a::coefficients(), digits)) == "6 and 4");
  }
  BOOST_TEST(orders(srkn11b::word{}, rounded(srkn11b::coefficients(), 1e7)) == "0 and 0");
}

BOOST_AUTO_TEST_CASE(what_is_no_number_is_not_consistent) {
  using limits = std::numeric_limits<double>;
  for (const double wrong : {limits::quiet_NaN(), limits::infinity(), limits::max()}) {
    BOOST_TEST(orders(verlet::word{}, std::array{0.5, wrong, 0.5}) == "0 and 0");
    BOOST_TEST(orders(verlet::word{}, std::array{wrong, 1.0, -wrong}) == "0 and 0");
  }
}

// On the oscillator this one has order 6 (see methods/step_laws_test.cpp).
BOOST_AUTO_TEST_CASE(an_accident_on_the_oscillator_does_not_count) {
  const auto c = palindrome<11>({0.18685656311551122, 0.5642486163110636,  //
                                 0.5520581660514783, -0.23936270217732913});
  using kick_first_11 = alternating_word<kick, drift, 11>;
  BOOST_TEST(orders(kick_first_11{}, c) == "4 and 4");
}
