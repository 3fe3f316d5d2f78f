// SPDX-License-Identifier: BSL-1.0
// The least loss, objective and error measure: what docs/concepts shows, and that they do their work.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <span>
#include <vector>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/losses/own_loss.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "quartic_well.hpp"

using namespace nysalt::test;

namespace {

constexpr double eps = 0x1p-52;

// [own_loss]
/// The error of the positions after five steps.
const nysalt::own_loss of_place{
    "place", 5,
    []<class T>(const nysalt::phase_point<T, 1>&, const nysalt::phase_point<T, 1>& finish,
                const nysalt::phase_point<T, 1>& wanted) -> T { return finish.q[0] - wanted.q[0]; }};
// [/own_loss]

// [objective]
/// How wrong the phase of A(a) B(1/2) A(1 - 2a) B(1/2) A(a) is on an oscillator, z = h omega: half the trace
/// of the exact step is cos z.
nysalt::objective phase_error(double z) {
  return [z](const Eigen::VectorXd& theta) {
    const double a = theta[0];
    const double r = 1.0 - z * z / 2.0 + a * (1.0 - 2.0 * a) / 4.0 * std::pow(z, 4) - std::cos(z);
    const double slope = (1.0 - 4.0 * a) / 4.0 * std::pow(z, 4);
    return nysalt::squares{r * r, Eigen::VectorXd::Constant(1, r * slope),
                           Eigen::MatrixXd::Constant(1, 1, slope * slope)};
  };
}
// [/objective]

// [error_measure]
/// Root mean square error of the first coordinate, over all trajectories and times.
const nysalt::error_measure first_coordinate{
    .name = "first coordinate",
    .width = 1,
    .read = [](const auto& x, auto result) { result[0] = x.q[0]; },
    .error = [](auto seen, auto expected) { return (seen[0] - expected[0]) * (seen[0] - expected[0]); },
    .how = nysalt::averaging::root_of_all};
// [/error_measure]

}  // namespace

BOOST_AUTO_TEST_CASE(a_loss_of_ones_own_says_what_its_residuals_are) {
  const nysalt::harmonic_oscillator system(1.0);
  const auto error = nysalt::own_error<double>(system, of_place.error);
  using C = decltype(error)::scalar;
  const auto of_data = [](const auto& x) { return decltype(error)::data_point{x.q, x.p}; };
  decltype(error)::point finish = of_data(at(3.0, 4.0)).cast<C>();
  finish.q[0] = C::variable(3.0, 1);
  C r;
  error.of(of_data(at(1.0, 0.0)), finish, of_data(at(2.5, 7.0)), &r);
  BOOST_TEST(error.residuals == 1U);
  BOOST_TEST(r.value == 0.5);
  BOOST_TEST(r.derivative[0] == 0.0);
  BOOST_TEST(r.derivative[1] == 1.0);
}

BOOST_AUTO_TEST_CASE(an_objective_tells_its_own_slope) {
  const auto loss = phase_error(1.5);
  const auto at_a = [&](double a) { return loss(Eigen::VectorXd::Constant(1, a)); };
  const double a = 0.21;
  const double d = 1e-5;
  const double difference = (at_a(a + d).value - at_a(a - d).value) / (2.0 * d);
  // Central differences err by d^2 times a third derivative below 10.
  BOOST_TEST(std::abs(at_a(a).gradient()[0] - difference) < 10 * d * d + 4 * eps / d);
  BOOST_TEST(std::abs(difference) > 1e-4);
}

BOOST_AUTO_TEST_CASE(an_error_measure_reads_compares_and_averages) {
  const nysalt::error_measure& measure = first_coordinate;
  const auto seen = measure.numbers_of(at(3.0, 0.0));
  const auto expected = measure.numbers_of(at(1.0, 5.0));
  BOOST_TEST(measure.error(seen, expected) == 4.0);
  const std::vector<double> scores{measure.score(8.0, 2.0), measure.score(8.0, 2.0)};
  BOOST_TEST(measure.average(scores).mean == 2.0);  // the root of the mean square
}
