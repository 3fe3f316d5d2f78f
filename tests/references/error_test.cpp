// SPDX-License-Identifier: BSL-1.0
// References tell their own error, and it is of the right size.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/references/odeint.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
using wrong = std::invalid_argument;
const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinite = std::numeric_limits<double>::infinity();
}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(good_references_report_small_errors, Model, various_systems) {
  const auto system = Model::make();
  draws random;
  const auto x = random.state(system, Model::reach);
  const double time = 1.0;
  // A step errs by at most the tolerance times 1 + |x|, and some 50 suffice; motion magnifies it by |J|,
  // which is below the highest frequency, 10, or 1 + t.
  BOOST_TEST(reference_error(system, odeint_reference(1e-12), x, time) <= 50.0 * 2e-12 * size_of(x) * 10.0);
  if constexpr (NystromSystem<system_of<Model>>) {
    // 3000 steps of 23 letters, each of which rounds twice.
    BOOST_TEST(reference_error(system, fine_steps(1.0 / 2000.0), x, time) <=
               3000.0 * 46.0 * eps * size_of(x) * 10.0);
  }
}

// The difference from half the step is 3/4 of the error of a second-order method.
BOOST_AUTO_TEST_CASE(a_coarse_reference_is_honest) {
  const henon_heiles system;
  draws random;
  const auto x = random.state(system, 0.25);
  const fine_steps<verlet> coarse(0.05);
  auto truth = x;
  odeint_reference(1e-14).advance(system, truth, 2.0);
  auto y = x;
  coarse.advance(system, y, 2.0);
  const double error = distance(y, truth);
  const double reported = reference_error(system, coarse, x, 2.0);
  BOOST_TEST(error > 1e-6);
  BOOST_TEST(std::abs(reported / error - 0.75) <= 0.05);  // (w h)^2 relative, some 1e-2, is left
  auto finer = x;
  coarse.finer().advance(system, finer, 2.0);
  BOOST_TEST(std::abs(distance(finer, truth) / error - 0.25) <= 0.05);
}

BOOST_AUTO_TEST_CASE(fine_steps_fit_into_the_time) {
  const pendulum system;
  phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  const fine_steps<> fine(0.1);
  for (const double t : {0.25, 0.05, 0.3001, -0.1, 0.0, not_a_number, infinite}) {
    BOOST_TEST(refuses<wrong>([&] { fine.advance(system, x, t); }, {"fine_steps", "multiple", "0.1"}));
  }
  BOOST_TEST(x.q[0] == 1.0);                           // untouched
  BOOST_CHECK_NO_THROW(fine.advance(system, x, 0.3));  // 0.3/0.1 is not 3 to the bit
  for (const double step : {0.0, -0.1, not_a_number, infinite}) {
    BOOST_TEST(refuses<wrong>([&] { fine_steps<>{step}; }, {"fine_steps", "positive"}));
  }
  BOOST_TEST(fine.description() == "srkn11b with step 0.1");
}

BOOST_AUTO_TEST_CASE(the_tolerance_of_odeint_lies_between_0_and_1) {
  for (const double tolerance : {0.0, 1.0, -1e-9, not_a_number, infinite}) {
    BOOST_TEST(
        refuses<wrong>([&] { odeint_reference{tolerance}; }, {"odeint_reference", "tolerance", "(0, 1)"}));
  }
  BOOST_TEST(odeint_reference(1e-9).finer().tolerance() == 1e-11, boost::test_tools::tolerance(1e-15));
}

// q = e^{-gamma t/2} (cos w t + gamma/(2 w) sin w t), w^2 = omega^2 - gamma^2/4. Some 50 steps, each within
// the tolerance times 1 + |x|, and the motion magnifies by omega at most.
BOOST_AUTO_TEST_CASE(odeint_damps_and_refuses_noise) {
  const double gamma = 0.6;
  const double omega = 2.0;
  const double t = 1.5;
  const harmonic_oscillator alone(omega);
  const in_bath damped(alone, bath::of_sigma(gamma, 0.0));
  const phase_point<double, 1> start{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  auto x = start;
  odeint_reference(1e-12).advance(damped, x, t);
  const double w = std::sqrt(omega * omega - 0.25 * gamma * gamma);
  const double decay = std::exp(-0.5 * gamma * t);
  const double q = decay * (std::cos(w * t) + 0.5 * gamma / w * std::sin(w * t));
  const double p = -decay * omega * omega / w * std::sin(w * t);
  BOOST_TEST(std::abs(x.q[0] - q) <= 50.0 * 4e-12 * omega);
  BOOST_TEST(std::abs(x.p[0] - p) <= 50.0 * 4e-12 * omega);
  auto undamped = start;
  odeint_reference(1e-12).advance(alone, undamped, t);
  BOOST_TEST(std::abs(undamped.q[0] - q) > 0.1);

  const in_bath noisy(alone, bath::of_sigma(gamma, 0.1));
  BOOST_TEST(refuses<wrong>([&] { odeint_reference(1e-12).advance(noisy, x, t); },
                            {"odeint_reference", "without noise", "fine_paths"}));
}
