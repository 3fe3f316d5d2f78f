// SPDX-License-Identifier: BSL-1.0
// The least model of each concept, which docs/concepts shows: scalar, system with its optional members, bath,
// noise, flow, word, family, method, reference, ensemble, observer, loss, objective and error measure; and
// that they do their work.
#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/core.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/family.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/model.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/systems/requirements.hpp"

namespace {

constexpr double eps = 0x1p-52;

// [system]
struct quartic_well {
  static constexpr int dimension = 1;

  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    const T square = q[0] * q[0];
    return square * square * 0.25;
  }
};
static_assert(nysalt::NystromSystem<quartic_well>);
// [/system]

/// A state of one coordinate.
nysalt::phase_point<double, 1> at(double q, double p) {
  return {nysalt::vector<double, 1>(q), nysalt::vector<double, 1>(p)};
}

// [scalar]
/// What does a step do where every operation rounds to 24 bits?
struct single {
  float value = 0.0F;

  single() = default;
  single(double x) : value(static_cast<float>(x)) {}

  friend single operator+(const single& a, const single& b) { return double(a.value + b.value); }
  friend single operator-(const single& a, const single& b) { return double(a.value - b.value); }
  friend single operator*(const single& a, const single& b) { return double(a.value * b.value); }
  friend single operator/(const single& a, const single& b) { return double(a.value / b.value); }
  friend single operator-(const single& a) { return double(-a.value); }
  single& operator+=(const single& b) { return *this = *this + b; }
  single& operator-=(const single& b) { return *this = *this - b; }
};
static_assert(nysalt::Scalar<single>);
// [/scalar]
static_assert(nysalt::CoefficientOf<double, single> && !nysalt::CoefficientOf<single, double>);

// [kinetic_energy]
struct relativistic_well : quartic_well {
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 1>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + 1.0);
  }
};
static_assert(nysalt::SeparableSystem<relativistic_well>);
static_assert(!nysalt::NystromSystem<relativistic_well>);
// [/kinetic_energy]

// [time]
/// q'' = -q + t: time is a coordinate that runs at speed 1, as K = p^2/2 + p_t.
struct pulled_ever_harder {
  static constexpr int dimension = 2;  // q, t

  template <class T>
  T potential(const nysalt::vector<T, 2>& q) const {
    return q[0] * q[0] * 0.5 - q[0] * q[1];
  }
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 2>& p) const {
    return p[0] * p[0] * 0.5 + p[1];
  }
};
// [/time]
static_assert(nysalt::SeparableSystem<pulled_ever_harder> && !nysalt::NystromSystem<pulled_ever_harder>);

// [black_box]
struct from_elsewhere {
  static constexpr int dimension = 1;

  void force(const nysalt::vector<double, 1>& q, nysalt::vector<double, 1>& f) const {
    f[0] = -std::sin(q[0]);
  }
};
static_assert(nysalt::BlackBoxForce<from_elsewhere>);
static_assert(nysalt::SeparableSystem<from_elsewhere>);
// [/black_box]

// [quadratic_part]
/// V = omega^2 q^2/2 + q^4/4.
struct stiff_well {
  static constexpr int dimension = 1;
  double omega = 100.0;

  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    const T square = q[0] * q[0];
    return square * (0.5 * omega * omega) + square * square * 0.25;
  }
  nysalt::normal_modes modes() const {
    return {Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Constant(1, omega)};
  }
  template <class T>
  void soft_force(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& f) const {
    f[0] = -(q[0] * q[0] * q[0]);
  }
  std::vector<nysalt::frequency_band> frequency_bands() const { return {{omega, 1.01 * omega}}; }
};
static_assert(nysalt::HasQuadraticPart<stiff_well> && nysalt::HasFrequencyBands<stiff_well>);
// [/quadratic_part]

// [bath]
struct warm_well : quartic_well {
  nysalt::bath bath() const { return nysalt::bath::of_temperature(0.1, 1.0); }  // friction, kT
};
static_assert(nysalt::HasBath<warm_well>);
static_assert(nysalt::HasBath<nysalt::in_bath<quartic_well>>);  // the same, of any system
// [/bath]

// [noise]
/// The mirror image of another noise. Means over both paths of a pair err less than over two others.
struct antithetic {
  static constexpr bool is_memoryless = true;
  nysalt::counter_noise plain;

  template <class T, int N>
  void normals(const nysalt::noise_place& at, nysalt::vector<T, N>& xi) const {
    plain.normals(at, xi);
    for (T& x : xi) x = -x;
  }
  template <class T, int N>
  void halving(const nysalt::noise_place& at, nysalt::vector<T, N>& zeta) const {
    plain.halving(at, zeta);
    for (T& x : zeta) x = -x;
  }
};
static_assert(nysalt::NoiseSource<antithetic>);
// [/noise]

// [flow]
/// The flow of -sum q_i: a uniform field pulls every coordinate, p_i += c h.
struct pull {
  static constexpr char letter = 'u';
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
  template <nysalt::System S, class State, class C>
  static void apply(const S&, const C& c, State& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += c;
  }
};
static_assert(nysalt::Flow<pull>);
// [/flow]

// [word]
constexpr nysalt::word five_letters("ABABA");
static_assert(five_letters.merges);                     // the last A of a step and the first of the next
static_assert(five_letters.evaluations_per_step == 2);  // however many steps
static_assert(five_letters.evaluations_to_open == 0);
// [/word]

// [family]
/// A(a) B(1/2) A(1 - 2a) B(1/2) A(a)
struct equal_kicks : nysalt::composition<1> {
  static constexpr nysalt::word letters = five_letters;
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
const nysalt::method symplectic_euler("symplectic_euler", nysalt::word("BA"), {1.0, 1.0},
                                      {.order = 1, .symmetric = false, .requires_quadratic_kinetic = false});
// [/method]

// [reference]
/// Of the oscillator of frequency 1 the flow is a rotation.
struct quarter_turns {
  std::int64_t advance(const nysalt::model&, nysalt::phase_point<double, Eigen::Dynamic>& x, double t) const {
    const double q = x.q[0];
    x.q[0] = std::cos(t) * q + std::sin(t) * x.p[0];
    x.p[0] = std::cos(t) * x.p[0] - std::sin(t) * q;
    return 0;  // evaluations of the force
  }
  quarter_turns finer() const { return *this; }
  std::string description() const { return "the exact rotation"; }
};
static_assert(nysalt::ReferenceFlow<quarter_turns>);
// [/reference]

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

BOOST_AUTO_TEST_CASE(a_step_in_single_precision_is_that_of_doubles_to_24_bits) {
  const quartic_well system;
  auto x = at(1.0, 0.5).cast<single>();
  auto y = at(1.0, 0.5);
  const auto stepper = nysalt::make_stepper(system, nysalt::verlet(), 0.1);
  stepper.step(x);
  stepper.step(y);
  const double error = std::abs(double(x.q[0].value) - y.q[0]) + std::abs(double(x.p[0].value) - y.p[0]);
  BOOST_TEST(error > 0.0);           // the digits are others
  BOOST_TEST(error < 16 * 0x1p-23);  // of eight operations on each coordinate, both below 1.1
}

BOOST_AUTO_TEST_CASE(systems_and_their_optional_members_step) {
  // [ask]
  nysalt::require_suited<quartic_well>();
  // [/ask]

  // B(h/2) A(h) B(h/2) of the quartic well from (1, 0), by hand.
  const quartic_well system;
  const double p = -0.05;
  const double q = 1.0 + 0.1 * p;
  auto x = at(1.0, 0.0);
  nysalt::make_stepper(system, nysalt::verlet(), 0.1).step(x);
  BOOST_TEST(std::abs(x.q[0] - q) <= 4 * eps);  // two roundings of numbers below 1
  BOOST_TEST(std::abs(x.p[0] - (p - 0.05 * q * q * q)) <= 4 * eps);

  auto fast = at(0.0, 10.0);
  const relativistic_well light;
  nysalt::make_stepper(light, nysalt::verlet_aba(), 0.1).step(fast);
  BOOST_TEST(fast.q[0] < 0.1);  // nothing is faster than light, whose speed is 1

  const from_elsewhere pendulum;
  auto z = at(0.0, 0.1);
  BOOST_TEST(nysalt::symplecticity_defect(pendulum, nysalt::verlet(), 0.1, z) < 1e-8);  // by differences

  const stiff_well stiff;
  const auto start = at(0.01, 0.5);
  const double before = nysalt::energy<double>(stiff, start);
  const auto end = nysalt::integrate(stiff, nysalt::impulse(), 0.05, start, 1000);  // h omega = 5
  // The soft force is below |q|^3 with |q| < 0.02, so that a step changes H by less than 0.05 |p| |q|^3.
  BOOST_TEST(std::abs(nysalt::energy<double>(stiff, end.finish) - before) < 1000 * 0.05 * 1.5 * 8e-6);
  BOOST_TEST(nysalt::integrate(stiff, nysalt::verlet(), 0.05, start, 1000).diverged_at.has_value());
}

BOOST_AUTO_TEST_CASE(time_may_be_a_coordinate) {
  // From rest at t = 0 the solution is q = t - sin t. Verlet's error falls with the square of the step; what
  // comes after it, with the fourth, is h^2 of that.
  const pulled_ever_harder system;
  const nysalt::phase_point<double, 2> start{{0.0, 0.0}, {0.0, 0.0}};
  const auto error = [&](std::int64_t steps) {
    const double h = 2.0 / static_cast<double>(steps);
    return nysalt::integrate(system, nysalt::verlet(), h, start, steps).finish.q[0] - (2.0 - std::sin(2.0));
  };
  BOOST_TEST(std::abs(error(20)) > 1e-6);
  BOOST_TEST(std::abs(error(20) / error(40) - 4.0) < 0.04);
}

BOOST_AUTO_TEST_CASE(a_model_is_the_system_as_a_value) {
  // [model]
  const nysalt::model well = quartic_well();  // any system converts
  auto end = nysalt::phase_point<double, Eigen::Dynamic>{Eigen::VectorXd::Ones(1), Eigen::VectorXd::Zero(1)};
  nysalt::make_stepper(well, nysalt::verlet(), 0.1).step(end);
  // [/model]
  auto same = at(1.0, 0.0);
  const quartic_well by_type;
  nysalt::make_stepper(by_type, nysalt::verlet(), 0.1).step(same);
  BOOST_TEST(end.q[0] == same.q[0]);
  BOOST_TEST(end.p[0] == same.p[0]);
  BOOST_TEST(end.q[0] != 1.0);  // it moved
}

BOOST_AUTO_TEST_CASE(mirrored_noise_makes_a_mirrored_path) {
  const warm_well system;
  const nysalt::counter_noise plain(1);
  const auto walk = [&](const auto& noise) {
    return nysalt::integrate(nysalt::make_stepper(system, nysalt::baoab(), 0.1, noise), at(0.0, 0.0), 100)
        .finish;
  };
  const auto x = walk(plain);
  const auto y = walk(antithetic{plain});
  BOOST_TEST(x.q[0] != 0.0);
  BOOST_TEST(x.q[0] == -y.q[0]);
  BOOST_TEST(x.p[0] == -y.p[0]);
}

BOOST_AUTO_TEST_CASE(a_letter_of_ones_own_goes_through_the_same_loop) {
  // u(1/2) A u(1/2) is exact in a uniform field: q = t^2/2, p = t.
  const nysalt::with_letters<nysalt::detail::free_particle, pull> system;
  const nysalt::stepper stepper(system, nysalt::word_of<pull, nysalt::drift, pull>(), {0.5, 1.0, 0.5}, 0.125);
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
  BOOST_TEST(nysalt::symplecticity_defect(system, symplectic_euler, 0.1, x) <= 64 * eps);
  const nysalt::method some = nysalt::member(equal_kicks(), {0.2});
  BOOST_TEST(nysalt::symplecticity_defect(system, some, 0.1, x) <= 64 * eps);
  auto euler = at(1.0, 0.0);
  nysalt::make_stepper(system, symplectic_euler, 0.5).step(euler);
  BOOST_TEST(euler.q[0] == 0.75);
  BOOST_TEST(euler.p[0] == -0.5);
}

BOOST_AUTO_TEST_CASE(a_reference_and_an_ensemble_of_ones_own) {
  const nysalt::harmonic_oscillator system(1.0);
  const nysalt::reference exact = quarter_turns();
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
  const auto error = nysalt::detail::own_error<double>(system, of_place.error);
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
