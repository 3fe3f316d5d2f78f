// SPDX-License-Identifier: BSL-1.0
// Systems around systems: in a bath, or with a quadratic part split off, a system is what it was. With the
// time as a coordinate, which drifts carry, driven motion has its order, is symplectic and reversible, and is
// learned.
#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/systems/in_time.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const auto some_bath = bath::of_sigma(0.01, 0.05);
using wrong = std::invalid_argument;

/// What the concepts say of S is true of S in a bath, and force, energy, masses, modes and kick are the same.
template <System S>
void check_in_bath(const S& alone) {
  using W = in_bath<S>;
  static_assert(NystromSystem<W> && HasBath<W> && W::dimension == S::dimension);
  static_assert(HasEnergy<W> == HasEnergy<S> && HasModes<W> == HasModes<S>);
  static_assert(HasFrequencyBands<W> == HasFrequencyBands<S> && HasInverseMass<W> == HasInverseMass<S>);
  static_assert(HasForceDerivative<W> == HasForceDerivative<S> && BlackBoxForce<W> == BlackBoxForce<S>);
  static_assert(HasKick<W, double> == HasKick<S, double>);
  static_assert(HasKick<counted<W>, double> == HasKick<counted<S>, double>);
  static_assert(lanes_of<W> == lanes_of<S>);
  draws random;
  const W system(alone, some_bath);
  const auto x = random.state(alone, 0.5);
  auto f = make_vector<double>(alone);
  auto g = make_vector<double>(system);
  force<double>(alone, x.q, f);
  force<double>(system, x.q, g);
  BOOST_TEST((f == g));
  if constexpr (HasEnergy<S>) BOOST_TEST(energy<double>(system, x) == energy<double>(alone, x));
  if constexpr (HasModes<S>) BOOST_TEST((system.modes().frequencies == alone.modes().frequencies));
  if constexpr (HasInverseMass<S>) BOOST_TEST(system.inverse_mass(1) == alone.inverse_mass(1));
  if constexpr (HasKick<S, double>) {
    auto p = x.p;
    auto r = x.p;
    alone.kick(x.q, p, 0.3);
    system.kick(x.q, r, 0.3);
    BOOST_TEST((p == r));
  }
}

}  // namespace

static_assert(HasBath<in_bath<fpu_chain<3>>> && !HasBath<fpu_chain<3>>);
static_assert(HasBath<counted<in_bath<fpu_chain<3>>>> && HasBath<in_bath<counted<fpu_chain<3>>>>);
static_assert(lanes_of<in_bath<black_box>> == 1 && lanes_of<in_bath<pendulum>> == default_lanes);

// With modes, masses, bands, kicks, a force alone; fixed and dynamic.
BOOST_AUTO_TEST_CASE(in_a_bath_it_is_what_the_system_is) {
  check_in_bath(free_chain());
  check_in_bath(fpu_chain<3>(10.0));
  check_in_bath(black_box_with_derivative());
}

BOOST_AUTO_TEST_CASE(a_system_names_its_bath_if_that_acts) {
  const fpu_chain<3> chain(50.0);
  const in_bath system(chain, some_bath);
  BOOST_TEST(system.bath().sigma() == 0.05);
  BOOST_TEST(system.bath().friction() == 0.01);
  BOOST_TEST(counted(system).bath().sigma() == 0.05);
  BOOST_TEST(describe(system) == "fpu_chain(pairs=3, omega=50) in bath(friction=0.01, sigma=0.05)");
  BOOST_TEST(describe(counted(system)) == describe(system));
  BOOST_TEST(describe(system.base()) == describe(chain));
  BOOST_TEST(describe(in_bath(chain, bath::of_sigma(0.0, 0.0))) == describe(chain));
  BOOST_TEST(describe(in_bath(chain, bath::of_temperature(0.0, 1.0))) == describe(chain));
  BOOST_TEST(describe(in_bath(chain, bath::of_sigma(0.1, 0.0))) != describe(chain));
  // Another bath, another system: what was learned in one is not for the other.
  BOOST_TEST(describe(system) != describe(in_bath(chain, bath::of_sigma(0.01, 0.06))));
  const potential_only unnamed;
  BOOST_TEST(describe(in_bath(unnamed, some_bath)) == describe(unnamed) + " in " + some_bath.description());
}

// A quadratic part split off.

static_assert(HasQuadraticPart<with_quadratic_part<two_masses>>);
static_assert(HasQuadraticPart<with_quadratic_part<potential_only>>);
static_assert(!HasQuadraticPart<two_masses> && !HasQuadraticPart<potential_only>);

BOOST_AUTO_TEST_CASE(the_modes_are_those_of_the_matrix_and_the_masses) {
  const auto modes = split_masses().modes();
  BOOST_TEST(modes.frequencies[0] == 0.0);
  BOOST_TEST(std::abs(modes.frequencies[1] - std::sqrt(1.25)) <= 8.0 * eps);  // 1/m1 + 1/m2
  const with_quadratic_part split(henon_heiles(), Eigen::MatrixXd::Identity(2, 2) * 4.0);
  BOOST_TEST((split.modes().frequencies - Eigen::Vector2d(2.0, 2.0)).norm() <= 8.0 * eps);
  BOOST_TEST(describe(split) == describe(henon_heiles()) + " with a quadratic part of frequencies up to 2");
  BOOST_TEST(describe(split.base()) == describe(henon_heiles()));
  const auto made = [](const Eigen::MatrixXd& stiffness) {
    return [=] { with_quadratic_part(henon_heiles(), stiffness); };
  };
  BOOST_TEST(refuses<wrong>(made(Eigen::MatrixXd::Identity(3, 3)), {"with_quadratic_part"}));
  BOOST_TEST(refuses<wrong>(made(-Eigen::MatrixXd::Identity(2, 2)), {"with_quadratic_part", "must be >= 0"}));
  BOOST_TEST(refuses<wrong>(made(Eigen::MatrixXd{{1.0, 2.0}, {0.0, 1.0}}), {"symmetric"}));
  BOOST_TEST(!refuses<wrong>(made(Eigen::MatrixXd::Zero(2, 2)), {}));
}

// In time.

namespace {

const in_time<driven_pendulum> pendulum_in_time(driven_pendulum(0.4, 1.7));
const auto start = pendulum_in_time.state({vector<double, 1>(0.5), vector<double, 1>(-0.2)}, 0.3);

template <class M>
phase_point<double, 2> after(const M& method, double step, int steps) {
  return integrate(pendulum_in_time, method, step, start, steps).finish;
}

/// q'' = -q + cos(w t) from rest at q = 0 at the time 0: (cos w t - cos t)/(1 - w^2).
struct driven_oscillator {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q, const T& t) const {
    using std::cos;
    return q[0] * q[0] * 0.5 - q[0] * cos(t * 0.6);
  }
};
/// Unequal masses, each of which counts.
struct driven_pair {
  static constexpr int dimension = 2;
  double inverse_mass(Eigen::Index i) const { return i == 0 ? 1.0 : 0.25; }
  template <class T>
  T potential(const vector<T, 2>& q, const T& t) const {
    return (q[0] - q[1]) * (q[0] - q[1]) * 0.5 + q[0] * t;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(time_goes_as_it_does) {
  const auto end = after(verlet(), 0.125, 80);  // sums of eighths are exact
  BOOST_TEST(pendulum_in_time.time(start) == 0.3);
  BOOST_TEST(std::abs(pendulum_in_time.time(end) - 10.3) <= 80.0 * 10.0 * eps);
  BOOST_TEST(pendulum_in_time.at_its_time(start).q[0] == 0.5);
  BOOST_TEST(pendulum_in_time.at_its_time(start).p[0] == -0.2);
  BOOST_CHECK_THROW(driven_pendulum(std::numeric_limits<double>::quiet_NaN(), 1.0), wrong);
  BOOST_CHECK_THROW(pendulum_in_time.state({vector<double, 1>(0.0), vector<double, 1>(0.0)},
                                           std::numeric_limits<double>::infinity()),
                    wrong);
  static_assert(!NystromSystem<in_time<driven_pendulum>> && SeparableSystem<in_time<driven_pendulum>>);
}

// S6 at a step of .01 errs by some 1e-13, and rounding of 1000 steps by as much.
BOOST_AUTO_TEST_CASE(a_driven_oscillator_goes_where_it_must) {
  const in_time<driven_oscillator> system;
  const auto from = system.state({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.0);
  const auto end = integrate(system, blanes_moan_s6(), 0.01, from, 1000).finish;
  const double exact = (std::cos(6.0) - std::cos(10.0)) / (1.0 - 0.36);
  BOOST_TEST(std::abs(end.q[0] - exact) <= 1e-11);
  BOOST_TEST(std::abs(end.q[0] - (std::cos(6.06) - std::cos(10.0)) / 0.64) > 1e-3);
}

BOOST_AUTO_TEST_CASE(masses_of_driven_systems_count) {
  const in_time<driven_pair> system;
  const auto x = system.state({{0.1, 0.2}, {1.0, 2.0}}, 0.5);
  vector<double, 3> v;
  system.velocity(x.p, v);
  BOOST_TEST(v[0] == 1.0);
  BOOST_TEST(v[1] == 0.5);
  BOOST_TEST(v[2] == 1.0);
  BOOST_TEST(std::abs(energy<double>(system, x)) <= 4.0 * eps);
  BOOST_TEST(check_force(system, {x.q}, {x.p}).passed());
}

// Four products a sum, of entries of order one, each off by some hundred roundings.
BOOST_AUTO_TEST_CASE(steps_are_symplectic_and_go_back) {
  BOOST_TEST(symplecticity_defect(pendulum_in_time, pefrl(), 0.2, start) <= 4.0 * 100.0 * eps);
  auto x = start;
  make_stepper(pendulum_in_time, pefrl(), 0.2).step(x);
  BOOST_TEST(distance(x, start) > 0.01);
  make_stepper(pendulum_in_time, pefrl(), -0.2).step(x);
  BOOST_TEST(distance(x, start) <= 100.0 * eps);
}

BOOST_AUTO_TEST_CASE(a_method_is_learned_on_driven_motion) {
  std::vector<phase_point<double, 2>> states;
  for (int k = 0; k < 32; ++k) {
    states.push_back(pendulum_in_time.state(
        {vector<double, 1>(0.05 * k - 0.8), vector<double, 1>(0.3 - 0.02 * k)}, 0.37 * k));
  }
  const auto data = [&](std::ptrdiff_t from) {
    const listed<2> starts({states.begin() + from, states.begin() + from + 16});
    return make_flow_map_data(pendulum_in_time, starts, fine_steps(0.01, blanes_moan_s6()),
                              {.step = 0.5, .horizon = 5.0, .trajectories = 16, .seed = 1});
  };
  const auto found = learn(aba<3>(), pendulum_in_time, data(0), data(16), {.random_starts = 4});
  BOOST_TEST(found.summary.usable, found.summary.reason);
  BOOST_TEST(found.summary.held_out_loss < 0.6 * found.summary.held_out_start_loss);
}
