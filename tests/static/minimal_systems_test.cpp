// SPDX-License-Identifier: BSL-1.0
// The least scalar, systems with each of their optional members, bath and noise: what docs/concepts shows,
// and that they do their work.
#include <cmath>
#include <cstdint>
#include <vector>

#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/detail/requirements.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "quartic_well.hpp"

using namespace nysalt::test;

namespace {

constexpr double eps = 0x1p-52;

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
static_assert(!nysalt::Scalar<float>);  // a double times it is a double
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
static_assert(!nysalt::HasEnergy<from_elsewhere>);

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
static_assert(!nysalt::HasQuadraticPart<quartic_well>);

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
  nysalt::require_suited<nysalt::verlet, quartic_well>();
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
  const auto method = nysalt::tabulated(nysalt::verlet());
  auto end = nysalt::phase_point<double, Eigen::Dynamic>{Eigen::VectorXd::Ones(1), Eigen::VectorXd::Zero(1)};
  nysalt::make_stepper(well, method, 0.1).step(end);
  // [/model]
  nysalt::phase_point<double, 1> same{nysalt::vector<double, 1>(1.0), nysalt::vector<double, 1>(0.0)};
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
