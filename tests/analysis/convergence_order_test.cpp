// SPDX-License-Identifier: BSL-1.0
#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/convergence_order.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/palindromic.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/pendulum.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
const pendulum swing;
const phase_point<double, 1> start{vector<double, 1>(1.0), vector<double, 1>(0.5)};

order_measurement measure(const auto& method, const auto& reference, std::int64_t fewest, int halvings) {
  return convergence_order(swing, method, reference, start, 4.0, fewest, halvings);
}

/// A mistake in Verlet: the kick is a little too weak, which is not even consistent.
struct weak_kick : palindromic<kick, drift, 3> {
  static constexpr int order = 2;
  static std::string name() { return "weak_kick"; }
  static constexpr std::array<double, 3> coefficients() { return {0.499, 1.0, 0.499}; }
};

}  // namespace

// The steps are so small that the next even power of them adds less than a tenth to the error of the first:
// log2(1.1) < .15.
BOOST_AUTO_TEST_CASE(orders_are_those_of_the_methods) {
  const fine_steps<> fine(1e-2);
  BOOST_TEST(std::abs(measure(verlet(), fine, 16, 5).order - 2.0) < 0.15);
  BOOST_TEST(std::abs(measure(pefrl(), fine, 16, 4).order - 4.0) < 0.15);
  BOOST_TEST(std::abs(measure(blanes_moan_s6(), fine, 8, 4).order - 4.0) < 0.15);
  BOOST_TEST(std::abs(measure(srkn11b(), fine_steps<>(2.5e-3), 8, 3).order - 6.0) < 0.15);
  BOOST_TEST(measure(weak_kick(), fine, 16, 5).order < 1.0);
}

BOOST_AUTO_TEST_CASE(steps_are_halved_and_errors_measured_at_the_horizon) {
  const auto result = measure(verlet(), fine_steps<>(1e-2), 16, 3);
  BOOST_TEST(result.steps == (std::vector<double>{0.25, 0.125, 0.0625, 0.03125}),
             boost::test_tools::per_element());
  BOOST_REQUIRE(result.errors.size() == 4);
  auto exact = start;
  fine_steps<>(1e-2).advance(swing, exact, 4.0);
  const auto end = integrate(swing, verlet(), 0.0625, start, 64).finish;
  BOOST_TEST(result.errors[2] == distance(end, exact), boost::test_tools::tolerance(1e-12));
}

// Where a method is as good as the reference, what is left is no order.
BOOST_AUTO_TEST_CASE(noise_is_no_order) {
  BOOST_TEST(std::isnan(measure(verlet(), fine_steps<verlet>(0.125), 32, 4).order));
  BOOST_TEST(std::isnan(measure(srkn11b(), fine_steps<>(1e-3), 4000, 3).order));  // rounding alone
  BOOST_TEST(std::isnan(measure(verlet(), fine_steps<>(1e-2), 16, 0).order));     // a single step
}

// Steps in the noise do not count, but those above it do.
BOOST_AUTO_TEST_CASE(the_order_is_taken_above_the_noise) {
  const auto result = measure(srkn6b(), fine_steps<>(1e-2), 32, 10);
  BOOST_TEST(result.errors.back() < 1e-11);
  BOOST_TEST(std::abs(result.order - 4.0) < 0.15);
}

// Large steps run away; the order is that of those which do not.
BOOST_AUTO_TEST_CASE(what_diverged_has_no_error_and_no_part_in_the_order) {
  const phase_point<double, 2> x{{0.1, 0.2}, {0.25, -0.1}};
  const auto result = convergence_order(henon_heiles(), verlet(), fine_steps<>(1e-2), x, 40.0, 10, 9);
  BOOST_REQUIRE(result.errors.size() == 10);
  BOOST_REQUIRE(result.steps.size() == 10);
  BOOST_REQUIRE(integrate(henon_heiles(), verlet(), 4.0, x, 10).diverged_at.has_value());
  BOOST_TEST(result.errors[0] == std::numeric_limits<double>::infinity());
  BOOST_TEST(result.errors[9] < 1e-3);
  // Of the eight steps that remain only the two largest are off their power, by less than a third.
  BOOST_TEST(std::abs(result.order - 2.0) < 0.15);
}

BOOST_AUTO_TEST_CASE(steps_and_halvings_that_cannot_be_are_refused) {
  using wrong = std::invalid_argument;
  const fine_steps<> fine(1e-2);
  BOOST_TEST(refuses<wrong>([&] { measure(verlet(), fine, 0, 3); }, {"convergence_order", "got 0,"}));
  BOOST_TEST(refuses<wrong>([&] { measure(verlet(), fine, -4, 3); }, {"convergence_order", "got -4,"}));
  BOOST_TEST(refuses<wrong>([&] { measure(verlet(), fine, 16, -1); }, {"convergence_order", ", -1 and"}));
  for (const double horizon : {0.0, nowhere}) {
    BOOST_TEST(refuses<wrong>([&] { convergence_order(swing, verlet(), fine, start, horizon, 4, 2); },
                              {"convergence_order", "horizon"}));
  }
}
