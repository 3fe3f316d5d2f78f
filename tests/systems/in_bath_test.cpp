// SPDX-License-Identifier: BSL-1.0
// A system in a bath is the system, and knows its bath.
#include "nysalt/systems/in_bath.hpp"

#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../support/rounding.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/force.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/systems/counted.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const auto some_bath = bath::of_sigma(0.01, 0.05);

/// With modes, masses, bands, kicks, a potential alone, a force alone; fixed and dynamic.
using nystrom_systems =
    std::tuple<a_free_chain, an_fpu_chain, a_dynamic_one, a_differentiable_box, two_weights>;

template <class S>
using in = in_bath<S>;

}  // namespace

static_assert(HasBath<in<fpu_chain<3>>> && !HasBath<fpu_chain<3>>);
static_assert(HasBath<counted<in<fpu_chain<3>>>> && HasBath<in<counted<fpu_chain<3>>>>);
static_assert(lanes_of<in<black_box>> == 1 && lanes_of<in<pendulum>> == default_lanes);

BOOST_AUTO_TEST_CASE_TEMPLATE(it_is_what_the_system_is, Model, nystrom_systems) {
  using S = system_of<Model>;
  using W = in<S>;
  static_assert(NystromSystem<W> && HasBath<W> && W::dimension == S::dimension);
  static_assert(HasEnergy<W> == HasEnergy<S> && HasModes<W> == HasModes<S>);
  static_assert(HasFrequencyBands<W> == HasFrequencyBands<S> && HasInverseMass<W> == HasInverseMass<S>);
  static_assert(HasForceDerivative<W> == HasForceDerivative<S> && BlackBoxForce<W> == BlackBoxForce<S>);
  static_assert(HasKick<W, double> == HasKick<S, double>);
  static_assert(HasKick<counted<W>, double> == HasKick<counted<S>, double>);
  static_assert(lanes_of<W> == lanes_of<S>);

  draws random;
  const auto alone = Model::make();
  const W system(alone, some_bath);
  const auto x = random.state(alone, Model::reach);
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
