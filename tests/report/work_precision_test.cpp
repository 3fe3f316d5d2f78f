// SPDX-License-Identifier: BSL-1.0
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>

#include "nysalt/report/work_precision.hpp"

using namespace nysalt;

namespace {

work_precision_row at_cost(const std::string& method, double evaluations, double error,
                           std::int64_t diverged = 0) {
  return {method, 2.0 / evaluations, evaluations, 1e-9 * evaluations, {error, 0.1 * error}, diverged, 40};
}
/// Errors that fall with the square of the cost, out of order, beside another method's.
std::vector<work_precision_row> power_law() {
  return {at_cost("a", 400, 7 * std::pow(400, -2)), at_cost("b", 200, 99.0),
          at_cost("a", 100, 7 * std::pow(100, -2)), at_cost("a", 1600, 7 * std::pow(1600, -2))};
}

}  // namespace

BOOST_AUTO_TEST_CASE(between_rows_a_power_law_is_exact) {
  for (const double cost : {100.0, 130.0, 200.0, 399.0, 400.0, 900.0, 1600.0}) {
    const auto error = error_at_cost(power_law(), "a", cost);
    BOOST_REQUIRE(error.has_value());
    // Within 5 % a row counts as it is: at 399, .25 % from one, this error is then .5 % off. Elsewhere
    // rounding.
    BOOST_TEST(*error == 7 * std::pow(cost, -2), boost::test_tools::tolerance(cost == 399.0 ? 6e-3 : 1e-13));
  }
}

BOOST_AUTO_TEST_CASE(start_up_is_no_difference_in_cost) {
  // A row that costs 2 % more, and nothing cheaper beside it: it is the rival at 100 all the same.
  const std::vector<work_precision_row> rows{at_cost("a", 102.1, 1.89e-3), at_cost("a", 300, 1e-5)};
  BOOST_TEST(error_at_cost(rows, "a", 100.0).value() == 1.89e-3);
  BOOST_TEST(!error_at_cost(rows, "a", 90.0).has_value());
}

BOOST_AUTO_TEST_CASE(outside_the_rows_there_is_nothing) {
  BOOST_TEST(!error_at_cost(power_law(), "a", 90.0).has_value());
  BOOST_TEST(!error_at_cost(power_law(), "a", 1700.0).has_value());
  BOOST_TEST(!error_at_cost(power_law(), "b", 300.0).has_value());
  BOOST_TEST(!error_at_cost(power_law(), "c", 200.0).has_value());
  BOOST_TEST(!error_at_cost({}, "a", 200.0).has_value());
}

BOOST_AUTO_TEST_CASE(rows_with_diverged_trajectories_do_not_count) {
  auto rows = power_law();
  rows[2].diverged = 1;  // that at 100
  BOOST_TEST(!error_at_cost(rows, "a", 200.0).has_value());
  BOOST_TEST(!error_at_cost(rows, "a", 100.0).has_value());
  BOOST_TEST(error_at_cost(rows, "a", 900.0).has_value());
}

BOOST_AUTO_TEST_CASE(the_table_has_cost_and_error_side_by_side) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto csv = work_precision_table({at_cost("a", 200, 0.0123), at_cost("b", 50, nan, 40)}).csv();
  BOOST_TEST(csv ==
             "method,step,evaluations/time,ns/time,error,standard error,diverged\n"
             "a,0.01,200.0,200,1.23e-02,1.23e-03,0/40\n"
             "b,0.04,50.0,50,-,-,40/40\n");
}

BOOST_AUTO_TEST_CASE(the_panel_has_a_curve_for_each_method) {
  const auto by_evaluations =
      work_precision_panel(power_law(), "b", "cost", &work_precision_row::evaluations_per_time);
  BOOST_REQUIRE(by_evaluations.curves.size() == 2);
  BOOST_TEST(by_evaluations.log_log);
  BOOST_TEST(by_evaluations.x_label == "cost");
  BOOST_TEST(by_evaluations.curves[0].label == "a");
  BOOST_TEST(!by_evaluations.curves[0].emphasised);
  BOOST_TEST(by_evaluations.curves[1].emphasised);
  BOOST_TEST(by_evaluations.curves[0].x == (std::vector<double>{100, 400, 1600}),
             boost::test_tools::per_element());
  BOOST_TEST(by_evaluations.curves[1].y == (std::vector<double>{99}), boost::test_tools::per_element());
  BOOST_TEST(by_evaluations.curves[1].error == (std::vector<double>{9.9}), boost::test_tools::per_element());
  const auto by_seconds =
      work_precision_panel(power_law(), "b", "time", &work_precision_row::seconds_per_time);
  BOOST_TEST(by_seconds.curves[1].x[0] == 1e-9 * 200);
}
