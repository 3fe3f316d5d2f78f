// SPDX-License-Identifier: BSL-1.0
// On the oscillator the optimum in the energy norm has closed form, and depends on z = step omega alone.
#include <boost/test/unit_test.hpp>

#include "nysalt/ensembles/listed.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

using namespace nysalt;

namespace {

learned<nystrom> fit_at(double z, double omega) {
  const harmonic_oscillator system(omega);
  const listed<1> two_states({{vector<double, 1>(1.0 / omega), vector<double, 1>(0.0)},
                              {vector<double, 1>(0.0), vector<double, 1>(1.0)}});
  const double step = z / omega;
  const auto data = make_flow_map_data(system, two_states, exact_linear(system),
                                       {.step = step, .horizon = step, .trajectories = 2});
  return learn(nystrom{}, system, data, data, {.coordinates = coordinates::energy});
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_optimum_is_the_closed_one_for_every_frequency) {
  const std::vector<std::pair<double, double>> closed{
      {0.5, .402726524}, {1.0, .400581831}, {2.0, .390164224}};
  for (const auto& [z, beta1] : closed) {
    for (const double omega : {0.03, 1.0, 3.0, 50.0, 1e4}) {
      const auto fit = fit_at(z, omega);
      BOOST_TEST_CONTEXT(fit.summary.full()) {
        // Nine digits are given; rounding is far below: the minimum is found by its exact gradient.
        BOOST_TEST(std::abs(fit.method.parameters()[0] - 0.5) <= 1e-8);
        BOOST_TEST(std::abs(fit.method.parameters()[1] - beta1) <= 1e-8);
      }
    }
  }
}

// The digits decide: those of another z, or of the limit of small steps, are not found.
BOOST_AUTO_TEST_CASE(the_closed_form_is_sharp) {
  const double beta1 = fit_at(1.0, 3.0).method.parameters()[1];
  BOOST_TEST(std::abs(beta1 - .402726524) > 1e-3);
  BOOST_TEST(std::abs(beta1 - nystrom::start()[1]) > 1e-3);
}
