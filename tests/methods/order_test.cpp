// SPDX-License-Identifier: BSL-1.0
// The declared order is the measured one, on nonlinear problems.
#include <boost/test/unit_test.hpp>

#include <utility>

#include "../laws/models.hpp"
#include "../laws/order_law.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double allowed = 0.15;  // see measured_order

template <class Model>
auto problem(double reach) {
  draws random;
  const auto system = Model::make();
  return solve(system,
               {random.state(system, reach), random.state(system, reach), random.state(system, reach)}, 4.0);
}

template <class Model, Word W>
double order_of_word(const std::array<double, W::length>& coefficients) {
  static const auto solution =
      problem<Model>(2.0 * Model::reach);  // far out, where V is nonlinear, for a while
  return measured_order<W>(Model::make(), coefficients, solution);
}
template <class Model, Method M>
double order_on(const M& method) {
  return order_of_word<Model, typename M::word>(method.coefficients());
}

using kick_first_11 = alternating_word<kick, drift, 11>;

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(the_declared_order_is_the_measured_one, M, methods) {
  draws random;
  const auto method = any_method<M>(random);
  BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
    BOOST_TEST(std::abs(order_on<a_pendulum>(method) - M::order) <= allowed);
    BOOST_TEST(std::abs(order_on<a_galaxy>(method) - M::order) <= allowed);
  }
}

BOOST_AUTO_TEST_CASE_TEMPLATE(also_with_another_kinetic_energy, M, methods) {
  if constexpr (fits<M, a_fast_one>) {
    draws random;
    BOOST_TEST(std::abs(order_on<a_fast_one>(any_method<M>(random)) - M::order) <= allowed);
    BOOST_TEST(std::abs(order_on<a_faster_one>(any_method<M>(random)) - M::order) <= allowed);
  }
}

BOOST_AUTO_TEST_CASE(srkn11b_loses_its_order_where_it_is_refused) {
  BOOST_TEST(order_on<a_fast_one>(srkn11b()) < srkn11b::order - 1.0);
}

// Mistakes that a typist makes. The method stays consistent and symmetric, and order 2 is what remains.
BOOST_AUTO_TEST_CASE(a_wrong_digit_lowers_the_order) {
  const auto with_xi = [](double xi) {
    return palindrome<9>({xi, 0.5 + 0.2123418310626054, -0.06626458266981849});
  };
  const double right = order_of_word<a_pendulum, pefrl::word>(with_xi(0.1786178958448091));
  const double on_pendulum = order_of_word<a_pendulum, pefrl::word>(with_xi(0.1736178958448091));
  const double on_galaxy = order_of_word<a_galaxy, pefrl::word>(with_xi(0.1736178958448091));
  BOOST_TEST(std::abs(right - 4.0) <= allowed);
  BOOST_TEST(on_pendulum < 3.0);
  BOOST_TEST(on_galaxy < 3.0);
}

BOOST_AUTO_TEST_CASE(two_swapped_coefficients_lower_the_order) {
  auto c = srkn11b::coefficients();
  std::swap(c[1], c[3]);
  std::swap(c[21], c[19]);
  const double on_pendulum = order_of_word<a_pendulum, srkn11b::word>(c);
  const double on_galaxy = order_of_word<a_galaxy, srkn11b::word>(c);
  BOOST_TEST(on_pendulum < 3.0);
  BOOST_TEST(on_galaxy < 3.0);
}

// Why orders are not measured on the oscillator. Its Lie algebra is small: this method solves the four
// conditions on its matrix up to h^6 (by Newton's method) and no more.
BOOST_AUTO_TEST_CASE(the_oscillator_alone_is_not_to_be_trusted) {
  const auto c = palindrome<11>({0.18685656311551122, 0.5642486163110636,  //
                                 0.5520581660514783, -0.23936270217732913});
  BOOST_TEST(std::abs(order_of_word<an_oscillator, kick_first_11>(c) - 6.0) <= allowed);
  BOOST_TEST(std::abs(order_of_word<a_pendulum, kick_first_11>(c) - 4.0) <= allowed);
  BOOST_TEST(std::abs(order_of_word<a_galaxy, kick_first_11>(c) - 4.0) <= allowed);
}
