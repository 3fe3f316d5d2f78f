// SPDX-License-Identifier: BSL-1.0
// The least flow, word, family and method, and what they are tried by: reference, ensemble, observer, loss,
// objective and error measure. What docs/concepts shows, and that they do their work.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/losses/own_loss.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "quartic_well.hpp"

using namespace nysalt::test;

namespace {

constexpr double eps = 0x1p-52;

// [flow]
/// The flow of -sum q_i: a uniform field pulls every coordinate, p_i += c h.
struct pull {
  static constexpr char letter = 'U';
  static constexpr std::size_t slots = 1;
  static constexpr nysalt::field reads = nysalt::field::none;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = false;
  static constexpr bool additive = true;

  template <nysalt::System S, nysalt::Scalar T>
  static constexpr bool serves = true;

  template <nysalt::Scalar C>
  static C prepare(const C& c, double h) {
    return c * h;
  }
  template <nysalt::System S, nysalt::Scalar T, nysalt::CoefficientOf<T> C>
  static void apply(const S&, const C& c, nysalt::flow_state<T, S::dimension>& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += c;
  }
};
static_assert(nysalt::Flow<pull>);
// [/flow]
struct never_applied : pull {
  static void apply(auto&&...) = delete;
};
static_assert(!nysalt::Flow<never_applied>);

// [word]
using five_letters = nysalt::word<nysalt::drift, nysalt::kick, nysalt::drift, nysalt::kick, nysalt::drift>;
static_assert(nysalt::Word<five_letters>);
static_assert(five_letters::merges);                     // the last A of a step and the first of the next
static_assert(five_letters::evaluations_per_step == 2);  // however many steps
static_assert(five_letters::evaluations_to_open == 0);
// [/word]

// [family]
/// A(a) B(1/2) A(1 - 2a) B(1/2) A(a)
struct equal_kicks : nysalt::composition<1> {
  using word = five_letters;
  static constexpr std::string_view name = "equal_kicks";
  static std::array<double, 1> start() { return {0.25}; }

  template <nysalt::Scalar C>
  static std::array<C, 5> coefficients(const std::array<C, 1>& theta) {
    const C& a = theta[0];
    return {a, C(0.5), C(1.0) - a * 2.0, C(0.5), a};
  }
};
static_assert(nysalt::Family<equal_kicks>);
// [/family]

// [method]
struct symplectic_euler {
  using word = nysalt::word<nysalt::kick, nysalt::drift>;
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return "symplectic_euler"; }
  static std::array<double, 2> coefficients() { return {1.0, 1.0}; }
};
static_assert(nysalt::Method<symplectic_euler>);
// [/method]

// [reference]
/// Of the oscillator of frequency 1 the flow is a rotation.
struct quarter_turns {
  void advance(const nysalt::harmonic_oscillator&, nysalt::phase_point<double, 1>& x, double t) const {
    const double q = x.q[0];
    x.q[0] = std::cos(t) * q + std::sin(t) * x.p[0];
    x.p[0] = std::cos(t) * x.p[0] - std::sin(t) * q;
  }
  quarter_turns finer() const { return *this; }
  std::string description() const { return "the exact rotation"; }
};
static_assert(nysalt::Reference<quarter_turns, nysalt::harmonic_oscillator>);
// [/reference]
static_assert(!nysalt::Reference<quarter_turns, quartic_well>);

// [ensemble]
/// One after the other on the unit circle, a golden section of it apart; the seed turns all.
struct around_the_circle {
  nysalt::phase_point<double, 1> operator()(std::uint64_t seed, std::uint64_t n) const {
    const double turns =
        static_cast<double>(seed) * std::numbers::sqrt2 + static_cast<double>(n) * std::numbers::phi;
    const double angle = 2.0 * std::numbers::pi * (turns - std::floor(turns));
    return {nysalt::vector<double, 1>(std::cos(angle)), nysalt::vector<double, 1>(std::sin(angle))};
  }
  std::string description() const { return "around_the_circle()"; }
};
static_assert(nysalt::Ensemble<around_the_circle, nysalt::harmonic_oscillator>);
// [/ensemble]
static_assert(!nysalt::Ensemble<quarter_turns, nysalt::harmonic_oscillator>);

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

BOOST_AUTO_TEST_CASE(a_letter_of_ones_own_goes_through_the_same_loop) {
  // U(1/2) A U(1/2) is exact in a uniform field: q = t^2/2, p = t.
  const nysalt::detail::free_particle system;
  using fall = nysalt::word<pull, nysalt::drift, pull>;
  const nysalt::stepper<nysalt::detail::free_particle, fall> stepper(system, {0.5, 1.0, 0.5}, 0.125);
  auto run = stepper.open(at(0.0, 0.0));
  stepper.advance(run, 16);
  const auto x = stepper.synchronous(run);
  BOOST_TEST(x.q[0] == 2.0);  // a step of 1/8 makes every number exact
  BOOST_TEST(x.p[0] == 2.0);
}

BOOST_AUTO_TEST_CASE(families_and_methods_of_ones_own_are_symplectic) {
  const quartic_well system;
  const auto x = at(0.7, 0.3);
  // Seven roundings of entries below 2.
  BOOST_TEST(nysalt::symplecticity_defect(system, symplectic_euler(), 0.1, x) <= 64 * eps);
  const nysalt::member<equal_kicks> some({0.2});
  BOOST_TEST(nysalt::symplecticity_defect(system, some, 0.1, x) <= 64 * eps);
  auto euler = at(1.0, 0.0);
  nysalt::make_stepper(system, symplectic_euler(), 0.5).step(euler);
  BOOST_TEST(euler.q[0] == 0.75);
  BOOST_TEST(euler.p[0] == -0.5);
}

BOOST_AUTO_TEST_CASE(a_reference_and_an_ensemble_of_ones_own) {
  const nysalt::harmonic_oscillator system(1.0);
  const quarter_turns exact;
  const around_the_circle starts;
  const auto start = nysalt::sound_start(system, starts, 1, 5);
  BOOST_TEST(std::abs(start.q[0] * start.q[0] + start.p[0] * start.p[0] - 1.0) <= 8 * eps);
  BOOST_TEST(start.q[0] != starts(2, 5).q[0]);
  BOOST_TEST(nysalt::reference_error(system, exact, start, 3.0) == 0.0);
  auto x = start;
  exact.advance(system, x, std::numbers::pi / 2.0);
  BOOST_TEST(std::abs(x.q[0] - start.p[0]) <= 4 * eps);
}

BOOST_AUTO_TEST_CASE(an_observer_sees_synchronous_states_in_time) {
  const nysalt::harmonic_oscillator system(1.0);
  // [observer]
  double largest = 0.0;
  const auto watch = [&](std::int64_t /*n*/, double /*t*/, const nysalt::phase_point<double, 1>& x) {
    largest = std::max(largest, std::abs(x.q[0]));
  };
  nysalt::integrate(system, nysalt::verlet(), 0.1, at(0.0, 1.0), 1000, watch, 10);
  // [/observer]
  // Verlet keeps q^2 (1 - z^2/4) + p^2: the largest q lies below 1/sqrt(1 - z^2/4), and near it.
  BOOST_TEST(largest < 1.0 / std::sqrt(1.0 - 0.0025) + 1e-12);
  BOOST_TEST(largest > 0.99);
}

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
