// SPDX-License-Identifier: BSL-1.0
// Compiled with -O2: 12 s at -O0, 2 s at -O2.
// Numbers that are known from elsewhere: periods in closed form, energy errors that others measured, learned
// parameters of the paper, and what a step beyond Verlet's stability limit does. Tier 1 has the optima,
// parameters and errors that the program prints, in programs/cases/known_values.txt.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "../../support/rounding.hpp"
#include "nysalt/analysis/energy_drift.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/kepler_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/lennard_jones.hpp"
#include "nysalt/systems/phi4_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// The distance of a state after a time from the start.
template <System S>
double missed_after(const S& system, const phase_point<double, S::dimension>& x, double time, double steps) {
  auto y = x;
  fine_steps<>(time / steps).advance(system, y, time);
  return distance(x, y);
}

/// 11 kicks and 12 drifts a step round every coordinate twice.
double rounding(double steps) { return steps * 46.0 * eps; }

const fpu_chain<3> chain(50.0);

fit fit_of_chain(double step, std::uint64_t seed, const fit_options& options) {
  const auto data = [&](std::uint64_t number) {
    return make_flow_map_data(chain, fpu_law<3>(chain), fine_steps<>(2.5e-4), {.step = step, .seed = number});
  };
  return learn(run_time_family(nystrom()), chain, data(seed), data(seed + 1), options);
}

}  // namespace

// Kepler's third law: 2 pi for a semi-major axis of 1, whatever the eccentricity.
BOOST_AUTO_TEST_CASE(a_planet_returns_after_its_period) {
  for (const double e : {0.0, 0.6}) {
    const auto x = kepler_law(e)(1, 2);
    constexpr double steps = 7000.0;  // the fastest motion has z = sqrt(2/(1 - e)^3) h = 5e-3
    // An error d of the energy changes the period by 3 pi d, and the speed is 2 at most.
    BOOST_TEST(missed_after(kepler(), x, two_pi, steps) <= 2.0 * 3.0 * std::numbers::pi * rounding(steps));
    BOOST_TEST(missed_after(kepler(), x, two_pi * (1.0 + 1e-6), steps) > 1e-7);
  }
}

// One mode alone, so small that the quartic term is not felt: cubes of 1e-6 are 1e-18.
BOOST_AUTO_TEST_CASE(a_wave_of_phi4_returns_after_its_period) {
  const phi4_chain<16> chain;
  const auto modes = chain.modes();
  for (Eigen::Index k = 1; k < 16; ++k) {
    const phase_point<double, 16> x{modes.basis.col(k) * 1e-6, vector<double, 16>::Zero()};
    const double period = two_pi / modes.frequencies[k];
    constexpr double steps = 1000.0;
    const double quartic = 1e-18 * period * period;
    BOOST_TEST(missed_after(chain, x, period, steps) <= 1e-6 * rounding(steps) + quartic);
    BOOST_TEST(missed_after(chain, x, 1.01 * period, steps) > 1e-9);
  }
}

// Two atoms near their rest: the reduced mass is 1/2 and V'' = 72/2^{1/3} at r = 2^{1/6}.
BOOST_AUTO_TEST_CASE(two_atoms_return_after_their_period) {
  const lennard_jones<2, 2> pair;
  const double apart = std::pow(2.0, 1.0 / 6.0);
  const double period = two_pi / std::sqrt(2.0 * 72.0 / std::cbrt(2.0));
  const double amplitude = 1e-4;
  const phase_point<double, 4> x{vector<double, 4>(0.0, 0.0, apart + amplitude, 0.0),
                                 vector<double, 4>::Zero()};
  constexpr double steps = 2000.0;
  // The anharmonic period is longer by some (amplitude V'''/V'')^2 of itself, V'''/V'' = 21/r.
  const double late = std::pow(21.0 / apart * amplitude, 2) * two_pi;
  const double speed = amplitude * two_pi / period;
  BOOST_TEST(missed_after(pair, x, period, steps) <= speed * late + rounding(steps));
  BOOST_TEST(missed_after(pair, x, 1.01 * period, steps) > 1e-6);
}

// The largest energy error of Principia's symplectic integrators on a harmonic oscillator, from its own tests
// (github.com/mockingbirdnest/Principia): mass and stiffness 1, q = 1 and p = 0 at the start, step .2, 500
// units of time, |H - H_0| absolute. H_0 is 1/2, so that is half of the relative error. Its leapfrog begins
// with a drift: with a kick the error would be h^2/8 = 5.00e-3 instead of h^2/8/(1 - h^2/4) = 5.05e-3.
BOOST_AUTO_TEST_CASE(energy_errors_are_those_of_another_library) {
  const auto largest_error = [](const tabulated& method) {
    const phase_point<double, 1> start{vector<double, 1>(1.0), vector<double, 1>(0.0)};
    const auto record = energy_drift(harmonic_oscillator(1.0), method, .2, start, 2500);
    BOOST_TEST(!record.diverged_at.has_value());
    return 0.5 * record.largest;
  };
  for (const auto& [method, known] :
       std::vector<std::pair<tabulated, double>>{{tabulated(verlet_aba()), 5.05e-3},
                                                 {tabulated(mclachlan2()), 4.48e-5},
                                                 {tabulated(forest_ruth()), 6.27e-5},
                                                 {tabulated(mclachlan_atela4()), 7.52e-7},
                                                 {tabulated(mclachlan5()), 7.83e-7},
                                                 {tabulated(blanes_moan_s6()), 2.24e-7},
                                                 {tabulated(srkn6b()), 1.56e-9},
                                                 {tabulated(srkn11b()), 9.1e-12},
                                                 {tabulated(srkn14a()), 6.3e-13}}) {
    // The table gives two or three digits.
    BOOST_TEST(std::abs(largest_error(method) / known - 1.0) <= .02, method.name());
  }
  BOOST_TEST(largest_error(tabulated(bcss2())) >
             2.0 * 4.48e-5);  // the word of mclachlan2, another coefficient
}

// Table 1 of [li_lu_tao_ye_2023, section 5.2]. Its rows are rounded to 1e-4, and the parameters scatter with
// the seed by 2e-4 at the step .01, of which two deviations of both are allowed, and by less at .005.
BOOST_AUTO_TEST_CASE(parameters_of_the_chain_are_those_of_the_paper) {
  struct row {
    double step, b1, beta1, scatter;
  };
  for (const auto& [step, b1, beta1, scatter] :
       {row{.005, .5024, .4062, 5e-4}, {.01, .5070, .4078, 7.5e-4}}) {
    for (const std::uint64_t seed : {1U, 3U}) {
      const auto fit = fit_of_chain(step, seed, {.loss = loss_named("state:1")});
      BOOST_TEST_CONTEXT(fit.summary.full()) {
        BOOST_TEST(fit.summary.usable);
        BOOST_TEST(std::abs(fit.theta[0] - b1) <= scatter);
        BOOST_TEST(std::abs(fit.theta[1] - beta1) <= scatter);
      }
    }
  }
}

// At the step .04 the stiff springs move at Verlet's stability limit.
BOOST_AUTO_TEST_CASE(verlet_diverges_on_every_trajectory_and_the_learned_method_on_none) {
  constexpr double step = .04;
  constexpr std::int64_t steps = 3750;  // to T = 150
  const auto fit = fit_of_chain(step, 1, {});
  BOOST_TEST(fit.summary.usable);
  const tabulated learned(member<nystrom>({fit.theta[0], fit.theta[1]}));
  for (std::uint64_t m = 0; m < 200; ++m) {
    const auto start = fpu_law<3>(chain)(3, m);
    const auto by_verlet = integrate(chain, tabulated(verlet()), step, start, steps);
    BOOST_TEST_CONTEXT("trajectory " << m) {
      BOOST_REQUIRE(by_verlet.diverged_at.has_value());
      BOOST_TEST(*by_verlet.diverged_at > 0);
      BOOST_TEST(*by_verlet.diverged_at <= steps);
      BOOST_TEST(by_verlet.steps == *by_verlet.diverged_at);
      const auto by_learned = integrate(chain, learned, step, start, steps);
      BOOST_TEST(!by_learned.diverged_at.has_value());
      BOOST_TEST(by_learned.steps == steps);
    }
  }
}
