// SPDX-License-Identifier: BSL-1.0
// The letter O does to a momentum what the bath says, each mass in its measure.
#include "nysalt/flows/ornstein_uhlenbeck.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/scalars/pack.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <System S, Scalar C = double>
flow_state<double, 2> after(const S& system, const ornstein_uhlenbeck::prepared<C>& flow,
                            const vector<double, 2>& p, const vector<double, 2>& xi) {
  flow_state<double, 2> x{{{0.3, -0.2}, p}, {0.0, 0.0}};
  ornstein_uhlenbeck::apply(system, flow, xi, x);
  return x;
}

}  // namespace

static_assert(Flow<ornstein_uhlenbeck> && StochasticFlow<ornstein_uhlenbeck>);
static_assert(!ornstein_uhlenbeck::additive && !ornstein_uhlenbeck::moves_q &&
              ornstein_uhlenbeck::reads == field::none);

BOOST_AUTO_TEST_CASE(a_momentum_decays_and_is_kicked_at_random) {
  const auto noisy = bath::of_sigma(0.4, 0.9);
  const auto flow = ornstein_uhlenbeck::prepare(0.5, 0.2, noisy);
  BOOST_TEST(flow.decay == noisy.decay(0.1));
  BOOST_TEST(flow.deviation == noisy.deviation(0.1));
  const auto x = after(henon_heiles(), flow, {1.0, -2.0}, {0.7, 0.0});
  BOOST_TEST(x.p[0] == flow.decay + 0.7 * flow.deviation);
  BOOST_TEST(x.p[1] == -2.0 * flow.decay);
  BOOST_TEST((x.q == vector<double, 2>(0.3, -0.2)));
}

// sigma M^{1/2} dW: with mass 4 the noise is twice as large, and p^2/m has the same temperature.
BOOST_AUTO_TEST_CASE(a_heavier_mass_gets_more_noise) {
  const auto flow = ornstein_uhlenbeck::prepare(1.0, 0.2, bath::of_sigma(0.4, 0.9));
  const two_masses system;
  BOOST_REQUIRE(system.inverse_mass(1) == 0.25);
  const auto x = after(system, flow, {0.0, 0.0}, {1.0, 1.0});
  BOOST_TEST(x.p[0] == flow.deviation);
  BOOST_TEST(x.p[1] == 2.0 * flow.deviation);
}

BOOST_AUTO_TEST_CASE(without_noise_it_damps) {
  const auto flow = ornstein_uhlenbeck::prepare(1.0, 0.2, bath::of_sigma(0.4, 0.0));
  BOOST_TEST(flow.deviation == 0.0);
  flow_state<double, 2> x{{{0.3, -0.2}, {1.0, -2.0}}, {0.0, 0.0}};
  ornstein_uhlenbeck::damp(two_masses(), flow.decay, x);
  BOOST_TEST(x.p[0] == flow.decay);
  BOOST_TEST(x.p[1] == -2.0 * flow.decay);
}

BOOST_AUTO_TEST_CASE(a_letter_that_is_not_prepared_does_nothing) {
  const auto x = after(two_masses(), ornstein_uhlenbeck::prepared<double>{}, {1.0, -2.0}, {3.0, 3.0});
  BOOST_TEST((x.p == vector<double, 2>(1.0, -2.0)));
}

BOOST_AUTO_TEST_CASE(noise_cannot_go_back_in_time) {
  const auto noisy = bath::of_sigma(0.4, 0.9);
  const auto heating = bath::of_sigma(0.0, 0.9);
  const auto cold = bath::of_sigma(0.4, 0.0);
  for (const auto& heat_bath : {noisy, heating}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { ornstein_uhlenbeck::prepare(1.0, -0.2, heat_bath); },
                                              {"letter O", "back in time", "-0.2", "the sign of the step"}));
    BOOST_TEST(refuses<std::invalid_argument>([&] { ornstein_uhlenbeck::prepare(-1.0, 0.2, heat_bath); },
                                              {"back in time"}));
    BOOST_TEST(ornstein_uhlenbeck::prepare(0.0, 0.2, heat_bath).deviation == 0.0);
    BOOST_TEST(ornstein_uhlenbeck::prepare(-1.0, -0.2, heat_bath).deviation == heat_bath.deviation(0.2));
  }
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] { ornstein_uhlenbeck::prepare(pack<double, 3>(-1.0), 0.2, noisy); }, {"back in time"}));
  // What damps alone grows backwards: one undoes the other, to rounding.
  const double there = ornstein_uhlenbeck::prepare(1.0, 0.2, cold).decay;
  const double back = ornstein_uhlenbeck::prepare(1.0, -0.2, cold).decay;
  BOOST_TEST(back > 1.0);
  BOOST_TEST(std::abs(there * back - 1.0) <= 4.0 * eps);
}

// Coefficients that carry derivatives act on states that do.
BOOST_AUTO_TEST_CASE(derivatives_flow_through_it) {
  using D = dual<double, 1>;
  const auto flow = ornstein_uhlenbeck::prepare(D::variable(0.5, 0), 0.2, bath::of_sigma(0.4, 0.9));
  flow_state<D, 2> x{{{D(0.3), D(-0.2)}, {D(1.0), D(-2.0)}}, {D(0.0), D(0.0)}};
  vector<D, 2> xi(D(0.7), D(-0.1));
  ornstein_uhlenbeck::apply(two_masses(), flow, xi, x);
  BOOST_TEST(x.p[0].value == flow.decay.value + 0.7 * flow.deviation.value);
  BOOST_TEST(x.p[0].derivative[0] == flow.decay.derivative[0] + 0.7 * flow.deviation.derivative[0]);
  BOOST_TEST(x.p[0].derivative[0] != 0.0);
}
