// SPDX-License-Identifier: BSL-1.0
// The declared order is the measured one, on nonlinear problems.
#include <boost/test/unit_test.hpp>

#include <cstdint>
#include <map>
#include <utility>

#include "../laws/laws.hpp"
#include "nysalt/detail/palindrome.hpp"
#include "nysalt/methods/classical_methods.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double allowed = 0.15;  // see measured_order

/// Far out, where V is nonlinear, for a while; or less far and for longer, where a method of high order errs
/// by more than rounding at steps that are small enough.
const solved& problem(const std::string& system, bool for_longer) {
  static std::map<std::pair<std::string, bool>, solved> known;
  const auto found = known.find({system, for_longer});
  if (found != known.end()) return found->second;
  draws random;
  auto one = specimen_of(system);
  one.reach.reach *= for_longer ? 1.0 : 2.0;
  solved made(one.system, {one.at_random(random), one.at_random(random), one.at_random(random)},
              for_longer ? 24.0 : 4.0);
  return known.emplace(std::pair{system, for_longer}, std::move(made)).first->second;
}

double order_on(const std::string& system, const table& method, int declared = 0) {
  return declared < 6 ? measured_order(problem(system, false), method, 8)
                      : measured_order(problem(system, true), method, 64);
}
double order_on(const std::string& system, const tabulated& method) {
  return order_on(system, method, method.order);
}

const std::string split_pendulum = "pendulum() with";
const std::string galaxy = "henon_heiles";

tabulated row(std::string_view name) {
  for (const auto& one : classical_table) {
    if (one.name == name) return as_data(one);
  }
  throw std::invalid_argument("no such row");
}

/// The order of those that are fitted to a frequency is that of steps for each of which they are fitted: see
/// phase_fitted_test.cpp.
bool changes_with_step(const tabulated& method) { return method.name().starts_with("phase_fitted_"); }

}  // namespace

BOOST_AUTO_TEST_CASE(the_declared_order_is_the_measured_one) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    if (changes_with_step(method)) continue;
    for (const auto& one : specimens_with([](const model& system) {
           const std::string name = describe(system);
           return name.starts_with(split_pendulum) || name.starts_with(galaxy) ||
                  (has_quadratic_part(system) && !system.has_unit_mass() && system.size() == 2) ||
                  !has_quadratic_kinetic(system);
         })) {
      if (!suits(one.system, method)) continue;
      BOOST_TEST_CONTEXT(method.name() << " on " << describe(one.system)) {
        BOOST_TEST(std::abs(order_on(describe(one.system), method) - method.order) <= allowed);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(methods_lose_their_order_where_they_are_refused) {
  const auto another_kinetic = specimens_with([](const model& s) { return !has_quadratic_kinetic(s); });
  const std::string fast = describe(another_kinetic.front().system);
  BOOST_TEST(order_on(fast, table(row("srkn11b"))) < 6 - 1.0);
  BOOST_TEST(order_on(fast, table(row("mclachlan_atela4"))) < 4 - 0.5);
}

// Mistakes that a typist makes. The method stays consistent and symmetric, and order 2 is what remains.
BOOST_AUTO_TEST_CASE(a_wrong_digit_lowers_the_order) {
  table wrong = row("pefrl");
  BOOST_TEST(std::abs(order_on(split_pendulum, wrong) - 4.0) <= allowed);
  const double slip = 0.005;  // in the first coefficient; the drifts still sum to 1
  for (const std::size_t k : {0U, 8U}) wrong.coefficients[k] += slip;
  wrong.coefficients[4] -= 2.0 * slip;
  BOOST_TEST(order_on(split_pendulum, wrong) < 3.0);
  BOOST_TEST(order_on(galaxy, wrong) < 3.0);
}

BOOST_AUTO_TEST_CASE(two_swapped_coefficients_lower_the_order) {
  table wrong = row("srkn11b");
  std::swap(wrong.coefficients[1], wrong.coefficients[3]);
  std::swap(wrong.coefficients[21], wrong.coefficients[19]);
  BOOST_TEST(order_on(split_pendulum, wrong) < 3.0);
  BOOST_TEST(order_on(galaxy, wrong) < 3.0);
}

// With c = 0 Chin's method is three stages of order 2, and so it is with the sign of c turned.
BOOST_AUTO_TEST_CASE(a_wrong_gradient_lowers_the_order) {
  for (const double factor : {0.0, -1.0, 2.0}) {
    table wrong = row("chin4a");
    wrong.coefficients[3] *= factor;
    BOOST_TEST(std::abs(order_on(split_pendulum, wrong) - 2.0) <= allowed);
    BOOST_TEST(std::abs(order_on(galaxy, wrong) - 2.0) <= allowed);
  }
}

// Why orders are not measured on the oscillator. Its Lie algebra is small: this method solves the four
// conditions on its matrix up to h^6 (by Newton's method) and no more.
BOOST_AUTO_TEST_CASE(the_oscillator_alone_is_not_to_be_trusted) {
  const auto c = palindrome<11>({0.18685656311551122, 0.5642486163110636,  //
                                 0.5520581660514783, -0.23936270217732913});
  const table method{run_time_word("BABABABABAB"), {c.begin(), c.end()}};
  BOOST_TEST(std::abs(order_on("harmonic_oscillator", method) - 6.0) <= allowed);
  BOOST_TEST(std::abs(order_on(split_pendulum, method) - 4.0) <= allowed);
  BOOST_TEST(std::abs(order_on(galaxy, method) - 4.0) <= allowed);
}
