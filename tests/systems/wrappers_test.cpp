// SPDX-License-Identifier: BSL-1.0
// Systems around systems: in a bath, or with a quadratic part split off, a system is what it was.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/systems/counted.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const auto some_bath = bath::of_sigma(0.01, 0.05);
using wrong = std::invalid_argument;
const Eigen::MatrixXd spring{{1.0, -1.0}, {-1.0, 1.0}};  // that of two_masses

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

BOOST_AUTO_TEST_CASE(a_system_knows_its_bath_and_itself_alone) {
  const in_bath system(fpu_chain<3>(50.0), bath::of_temperature(0.1, 2.0));
  BOOST_TEST(system.bath().temperature() == 2.0);
  BOOST_TEST(system.bath().friction() == 0.1);
  BOOST_TEST(describe(system.base()) == "fpu_chain(pairs=3, omega=50)");
}

BOOST_AUTO_TEST_CASE(a_system_names_its_bath_if_that_acts) {
  const fpu_chain<3> chain(50.0);
  BOOST_TEST(describe(in_bath(chain, some_bath)) ==
             "fpu_chain(pairs=3, omega=50) in bath(friction=0.01, sigma=0.05)");
  BOOST_TEST(describe(in_bath(chain, bath::of_sigma(0.0, 0.0))) == describe(chain));
  BOOST_TEST(describe(in_bath(chain, bath::of_temperature(0.0, 1.0))) == describe(chain));
  BOOST_TEST(describe(in_bath(chain, bath::of_sigma(0.1, 0.0))) != describe(chain));
  // Another bath, another system: what was learned in one is not for the other.
  BOOST_TEST(describe(in_bath(chain, some_bath)) != describe(in_bath(chain, bath::of_sigma(0.01, 0.06))));
  const potential_only unnamed;
  BOOST_TEST(describe(in_bath(unnamed, some_bath)) == describe(unnamed) + " in " + some_bath.description());
}

BOOST_AUTO_TEST_CASE(counting_keeps_the_bath) {
  const counted watched(in_bath(fpu_chain<3>(50.0), some_bath));
  BOOST_TEST(watched.bath().sigma() == 0.05);
  BOOST_TEST(describe(watched) == describe(in_bath(fpu_chain<3>(50.0), some_bath)));
}

// A quadratic part split off changes nothing but what is soft.

static_assert(HasQuadraticPart<with_quadratic_part<two_masses>>);
static_assert(HasQuadraticPart<with_quadratic_part<potential_only>>);
static_assert(!HasQuadraticPart<two_masses> && !HasQuadraticPart<potential_only>);

BOOST_AUTO_TEST_CASE(what_is_soft_is_the_force_without_the_quadratic_part) {
  const with_quadratic_part split(two_masses(), spring);
  draws random;
  for (int n = 0; n < 10; ++n) {
    const auto q = random.state(split, 1.0).q;
    vector<double, 2> soft;
    split.soft_force(q, soft);
    for (Eigen::Index i = 0; i < 2; ++i) {
      BOOST_TEST(std::abs(soft[i] + q[i] * q[i] * q[i]) <= 8.0 * eps);  // eight operations below 1
    }
    vector<double, 2> whole;
    vector<double, 2> alone;
    force<double>(split, q, whole);
    force<double>(two_masses(), q, alone);
    BOOST_TEST((whole == alone));
    BOOST_TEST((whole - soft).norm() > 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(the_modes_are_those_of_the_matrix_and_the_masses) {
  const auto modes = with_quadratic_part(two_masses(), spring).modes();
  BOOST_TEST(modes.frequencies[0] == 0.0);
  BOOST_TEST(std::abs(modes.frequencies[1] - std::sqrt(1.25)) <= 8.0 * eps);  // 1/m1 + 1/m2
  const auto unit = with_quadratic_part(henon_heiles(), Eigen::MatrixXd::Identity(2, 2)).modes();
  BOOST_TEST((unit.frequencies - Eigen::Vector2d::Ones()).norm() <= 4.0 * eps);
}

BOOST_AUTO_TEST_CASE(it_says_what_was_split_off) {
  const with_quadratic_part split(henon_heiles(), Eigen::MatrixXd::Identity(2, 2) * 4.0);
  BOOST_TEST(describe(split) == describe(henon_heiles()) + " with a quadratic part of frequencies up to 2");
  BOOST_TEST(describe(split.base()) == describe(henon_heiles()));
}

BOOST_AUTO_TEST_CASE(a_matrix_that_does_not_fit_is_refused) {
  const auto made = [](const Eigen::MatrixXd& stiffness) {
    return [=] { with_quadratic_part(henon_heiles(), stiffness); };
  };
  BOOST_TEST(refuses<wrong>(made(Eigen::MatrixXd::Identity(3, 3)), {"with_quadratic_part"}));
  BOOST_TEST(refuses<wrong>(made(-Eigen::MatrixXd::Identity(2, 2)), {"with_quadratic_part", "must be >= 0"}));
  BOOST_TEST(refuses<wrong>(made(Eigen::MatrixXd{{1.0, 2.0}, {0.0, 1.0}}), {"symmetric"}));
  BOOST_TEST(!refuses<wrong>(made(Eigen::MatrixXd::Zero(2, 2)), {}));
}
