// SPDX-License-Identifier: BSL-1.0
// Classical methods: their rows as types and as data, their steps by formulas written out, several of them in
// one, and tables that cannot be.
#include "nysalt/methods/classical.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <string_view>

#include "../laws/laws.hpp"
#include "../support/refusal.hpp"
#include "../support/systems.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/methods/classical_methods.hpp"
#include "nysalt/methods/repeated.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/pendulum.hpp"

using namespace nysalt;
using namespace nysalt::test;

static_assert(Method<tabulated>);

namespace {

constexpr double h = 0.3;

/// Some ten operations on numbers of size 1, in another order.
constexpr double rounding = 10.0 * eps;

/// Nothing of it is soft.
struct two_oscillators : henon_heiles {
  template <class T>
  void soft_force(const vector<T, 2>&, vector<T, 2>& f) const {
    f[0] = f[1] = T(0.0);
  }
};

template <Method M>
void must_be_row(const M& method) {
  const tabulated as_type(method);
  for (const auto& row : classical_table) {
    if (row.name != method.name()) continue;
    const tabulated data = as_data(row);
    BOOST_TEST(as_type.letters().letters() == data.letters().letters());
    BOOST_TEST((as_type.coefficients() == data.coefficients()));
    BOOST_TEST(as_type.order == data.order);
    BOOST_TEST(as_type.symmetric == data.symmetric);
    BOOST_TEST(as_type.requires_quadratic_kinetic == data.requires_quadratic_kinetic);
    return;
  }
  BOOST_ERROR("no row is named " << method.name());
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_row_as_a_type_is_the_row_as_data) {
  must_be_row(verlet());
  must_be_row(mclachlan_atela4());  // not symmetric, for quadratic K alone
  must_be_row(omelyan_fg4());
  must_be_row(impulse());
  must_be_row(baoab());
}

BOOST_AUTO_TEST_CASE(names_are_unique_and_palindromes_are_symmetric) {
  std::set<std::string_view> names;
  for (const auto& row : classical_table) {
    BOOST_TEST(names.insert(row.name).second, row.name);
    BOOST_TEST(!row.source.empty(), row.name);
    const tabulated method = as_data(row);
    BOOST_TEST(is_palindrome(method.letters(), method.coefficients()) == row.symmetric, row.name);
  }
}

BOOST_AUTO_TEST_CASE(rivals_are_rows_without_a_bath_that_repeat_no_other) {
  std::set<std::string> names;
  for (const auto& method : nysalt::classical_methods()) names.insert(method.name());
  BOOST_TEST(names.contains("pefrl"));
  BOOST_TEST(names.contains("impulse"));
  BOOST_TEST(!names.contains("baoab"));
  BOOST_TEST(!names.contains("verlet_2x"));
}

// Takahashi and Imada's, and Chin's. V = -cos q: f = -sin q, f' f = cos q sin q.
BOOST_AUTO_TEST_CASE(gradient_methods_step_on_a_pendulum_by_their_formulas) {
  const pendulum system;
  const phase_point<double, 1> start{vector<double, 1>(0.7), vector<double, 1>(-0.4)};
  auto x = start;
  const auto drift = [&](double a) { x.q += a * h * x.p; };
  const auto kick = [&](double b, double c) {
    x.p[0] += -b * h * std::sin(x.q[0]) + 2.0 * c * h * h * h * std::cos(x.q[0]) * std::sin(x.q[0]);
  };
  const auto off = [&](const auto& method) {
    auto y = start;
    make_stepper(system, method, h).step(y);
    return distance(x, y);
  };
  drift(0.5);
  kick(1.0, 1.0 / 24.0);
  drift(0.5);
  BOOST_TEST(off(takahashi_imada()) <= rounding);
  BOOST_TEST(off(verlet_aba()) > 1e6 * rounding);  // the gradient matters
  x = start;
  kick(1.0 / 6.0, 0.0);
  drift(0.5);
  kick(2.0 / 3.0, 1.0 / 72.0);
  drift(0.5);
  kick(1.0 / 6.0, 0.0);
  BOOST_TEST(off(chin4a()) <= rounding);
}

// V = |q|^2/2 + q1^2 q2 - q2^3/3: two oscillators of frequency 1, and what is soft. Without a soft part the
// impulse method is exact at any step.
BOOST_AUTO_TEST_CASE(the_impulse_methods_step_on_a_galaxy) {
  phase_point<double, 2> x{{0.2, -0.1}, {0.3, 0.15}};
  const auto start = x;
  auto y = x;
  const henon_heiles system;
  make_stepper(system, impulse(), h).step(x);
  const auto half_kick = [&] {
    y.p[0] -= 0.5 * h * 2.0 * y.q[0] * y.q[1];
    y.p[1] -= 0.5 * h * (y.q[0] * y.q[0] - y.q[1] * y.q[1]);
  };
  half_kick();
  y = {std::cos(h) * y.q + std::sin(h) * y.p, std::cos(h) * y.p - std::sin(h) * y.q};
  half_kick();
  BOOST_TEST(distance(x, y) <= rounding);
  const two_oscillators linear;
  x = start;
  make_stepper(linear, impulse(), 2.0 * std::numbers::pi).step(x);
  BOOST_TEST(distance(x, start) <= rounding);
  make_stepper(linear, impulse(), std::numbers::pi).step(x);
  BOOST_TEST(distance(x, start) > 0.1);
}

BOOST_AUTO_TEST_CASE(a_repeated_method_is_its_steps_one_after_the_other) {
  draws random;
  const auto& galaxy = specimen_of("henon_heiles");
  for (const auto& method : nysalt::classical_methods()) {
    if (method.letters().letters().find('R') != std::string::npos) continue;
    for (const int times : {1, 2, 3}) {
      if (times > 1 && method.letters().is_processed()) continue;  // refused: see processed_test.cpp
      const auto whole = repeated(method, times);
      BOOST_TEST(whole.letters().evaluations_per_step == times * method.letters().evaluations_per_step);
      const auto x = galaxy.at_random(random);
      // Coefficients times h / n, or times h and then 1/n: two roundings for each of some 60 letters.
      BOOST_TEST(distance(run_of{galaxy.system, whole, h}.plain(x, 1),
                          run_of{galaxy.system, method, h / times}.plain(x, times)) < 1e-14,
                 method.name() << " " << times);
    }
  }
  BOOST_TEST(refuses<std::invalid_argument>([] { repeated(tabulated(baoab{}), 2); }, {"BAOAB"}));
  BOOST_TEST(
      refuses<std::invalid_argument>([] { repeated(nysalt::classical_methods().front(), 0); }, {"0 steps"}));
}

BOOST_AUTO_TEST_CASE(methods_of_a_cost_take_as_many_evaluations) {
  for (const int evaluations : {1, 2, 3, 4, 5, 6}) {
    const auto all = classical_methods_of_cost(evaluations);
    BOOST_TEST(all.size() >= 3U);
    for (const auto& method : all) BOOST_TEST(method.letters().evaluations_per_step == evaluations);
  }
}

BOOST_AUTO_TEST_CASE(tables_that_cannot_be_are_refused) {
  const method_properties nothing{1, false, false};
  const auto made = [&](const std::string& letters, const std::vector<double>& c) {
    return [=] { tabulated("mine", run_time_word(letters), c, nothing); };
  };
  using error = std::invalid_argument;
  BOOST_TEST(refuses<error>(made("ABA", {0.5, 1.0}), {"2 coefficients for the 3 letters ABA"}));
  BOOST_TEST(refuses<error>(made("AGA", {0.5, 1.0, 0.5}), {"3 coefficients", "G and H take two"}));
  BOOST_TEST(refuses<error>(made("AB", {std::numeric_limits<double>::quiet_NaN(), 1.0}),
                            {"coefficient 1 must be finite, got nan"}));
  BOOST_TEST(!refuses<error>(made("AB", {1.0, 1.0}), {}));
  // The order of srkn11b needs a quadratic kinetic energy; as data it can only say so when it is run.
  const relativistic fast;
  const tabulated needs_quadratic(srkn11b{});
  BOOST_TEST(refuses<error>([&] { make_stepper(fast, needs_quadratic, 0.1); },
                            {"kinetic energy must be quadratic"}));
  BOOST_CHECK_NO_THROW(make_stepper(fast, tabulated(srkn6b{}), 0.1));
  std::string letters;
  for (int n = 0; n < 65; ++n) letters += "BA";
  const tabulated too_long("long", run_time_word(letters), std::vector<double>(130, 1.0 / 65.0), nothing);
  BOOST_TEST(refuses<error>([&] { stability_windows(too_long); }, {"<= 64"}));
}
