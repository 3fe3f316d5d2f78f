// SPDX-License-Identifier: BSL-1.0
// The declared order is the measured one, on nonlinear problems.
#include <boost/test/unit_test.hpp>

#include <cstdint>
#include <utility>

#include "../laws/models.hpp"
#include "../laws/order_law.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double allowed = 0.15;  // see measured_order

/// Far out, where V is nonlinear, for a while; or less far and for longer, where a method of high order errs
/// by more than rounding at steps that are small enough.
struct place {
  double reach;
  double time;
  std::int64_t steps;
};
constexpr place far_out{2.0, 4.0, 8};
constexpr place for_longer{1.0, 24.0, 64};

template <class Model>
auto problem(const place& at) {
  draws random;
  const auto system = Model::make();
  const double reach = at.reach * Model::reach;
  return solve(system,
               {random.state(system, reach), random.state(system, reach), random.state(system, reach)},
               at.time);
}

template <class Model>
double order_on(const table& method, int declared = 0) {
  static const auto near = problem<Model>(far_out);
  static const auto far = problem<Model>(for_longer);
  return declared < 6 ? measured_order(Model::make(), method, near, far_out.steps)
                      : measured_order(Model::make(), method, far, for_longer.steps);
}
template <class Model, Method M>
double order_on(const M& method) {
  return order_on<Model>(table_of(method), method.order);
}

/// The order of those that are fitted to a frequency is that of steps for each of which they are fitted: see
/// phase_fitted_test.cpp.
bool changes_with_step(const tabulated& method) { return method.name().starts_with("phase_fitted_"); }

}  // namespace

BOOST_AUTO_TEST_CASE(the_declared_order_is_the_measured_one) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    if (changes_with_step(method)) continue;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
      BOOST_TEST(std::abs(order_on<a_split_pendulum>(method) - method.order) <= allowed);
      BOOST_TEST(std::abs(order_on<a_galaxy>(method) - method.order) <= allowed);
    }
  }
}

BOOST_AUTO_TEST_CASE(also_with_another_kinetic_energy) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    if (method.requires_quadratic_kinetic || changes_with_step(method)) continue;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
      BOOST_TEST(std::abs(order_on<a_fast_one>(method) - method.order) <= allowed);
      BOOST_TEST(std::abs(order_on<a_faster_one>(method) - method.order) <= allowed);
    }
  }
}

BOOST_AUTO_TEST_CASE(methods_lose_their_order_where_they_are_refused) {
  BOOST_TEST(order_on<a_fast_one>(table_of(srkn11b())) < srkn11b::order - 1.0);
  BOOST_TEST(order_on<a_fast_one>(table_of(mclachlan_atela4())) < mclachlan_atela4::order - 0.5);
}

// Mistakes that a typist makes. The method stays consistent and symmetric, and order 2 is what remains.
BOOST_AUTO_TEST_CASE(a_wrong_digit_lowers_the_order) {
  auto wrong = table_of(pefrl());
  BOOST_TEST(std::abs(order_on<a_split_pendulum>(wrong) - 4.0) <= allowed);
  const double slip = 0.005;  // in the first coefficient; the drifts still sum to 1
  for (const std::size_t k : {0U, 8U}) wrong.coefficients[k] += slip;
  wrong.coefficients[4] -= 2.0 * slip;
  BOOST_TEST(order_on<a_split_pendulum>(wrong) < 3.0);
  BOOST_TEST(order_on<a_galaxy>(wrong) < 3.0);
}

BOOST_AUTO_TEST_CASE(two_swapped_coefficients_lower_the_order) {
  auto wrong = table_of(srkn11b());
  std::swap(wrong.coefficients[1], wrong.coefficients[3]);
  std::swap(wrong.coefficients[21], wrong.coefficients[19]);
  BOOST_TEST(order_on<a_split_pendulum>(wrong) < 3.0);
  BOOST_TEST(order_on<a_galaxy>(wrong) < 3.0);
}

// With c = 0 Chin's method is three stages of order 2, and so it is with the sign of c turned.
BOOST_AUTO_TEST_CASE(a_wrong_gradient_lowers_the_order) {
  for (const double factor : {0.0, -1.0, 2.0}) {
    auto wrong = table_of(chin4a());
    wrong.coefficients[3] *= factor;
    BOOST_TEST(std::abs(order_on<a_split_pendulum>(wrong) - 2.0) <= allowed);
    BOOST_TEST(std::abs(order_on<a_galaxy>(wrong) - 2.0) <= allowed);
  }
}

// Why orders are not measured on the oscillator. Its Lie algebra is small: this method solves the four
// conditions on its matrix up to h^6 (by Newton's method) and no more.
BOOST_AUTO_TEST_CASE(the_oscillator_alone_is_not_to_be_trusted) {
  const auto c = palindrome<11>({0.18685656311551122, 0.5642486163110636,  //
                                 0.5520581660514783, -0.23936270217732913});
  const table method{run_time_word("BABABABABAB"), {c.begin(), c.end()}};
  BOOST_TEST(std::abs(order_on<an_oscillator>(method) - 6.0) <= allowed);
  BOOST_TEST(std::abs(order_on<a_split_pendulum>(method) - 4.0) <= allowed);
  BOOST_TEST(std::abs(order_on<a_galaxy>(method) - 4.0) <= allowed);
}
