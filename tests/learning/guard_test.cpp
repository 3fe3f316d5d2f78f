// SPDX-License-Identifier: BSL-1.0
// Where the best of a family is unstable, the guard does not return it.
#include "nysalt/learning/stability_guard.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/rounding.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const fpu_chain<3> chain(50.0);
const run_time_family four_kicks{aba<4>()};

struct fits {
  fit guarded;
  fit unguarded;
};
fits fits_at(double step) {
  const auto data_of = [&](std::uint64_t seed) {
    return make_flow_map_data(chain, fpu_law<3>(chain), fine_steps<>(5e-4),
                              {.step = step, .horizon = 10.0 * step, .trajectories = 50, .seed = seed});
  };
  const auto data = data_of(1);
  const auto held_out = data_of(2);
  // From equal steps alone: of all that the family would begin with, one finds stable words.
  fit_options options{.loss = loss_named("state:1"), .start = four_kicks.starts[0].theta, .random_starts = 0};
  const auto guarded = learn(four_kicks, chain, data, held_out, options);
  options.guarded = false;
  return {guarded, learn(four_kicks, chain, data, held_out, options)};
}

/// The largest |trace|/2 of a step on oscillators within the chain's bands: above 1 they grow.
double largest_half_trace(const fit& found, double step) {
  const auto c = four_kicks.coefficients(found.theta);
  double largest = 0.0;
  for (const auto& band : chain.frequency_bands()) {
    for (int n = 0; n <= 2000; ++n) {
      const harmonic_oscillator mode(std::max(1e-3, band.low + (band.high - band.low) * n / 2000.0));
      const stepper one(mode, four_kicks.letters, c, step);
      phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
      phase_point<double, 1> y{vector<double, 1>(0.0), vector<double, 1>(1.0)};
      one.step(x);
      one.step(y);
      largest = std::max(largest, 0.5 * std::abs(x.q[0] + y.p[0]));
    }
  }
  return largest;
}

// What the guard calls rounding, and some 20 of entries that nine letters may magnify to some 50.
constexpr double rounding = 1e-10 + 20.0 * 50.0 * eps;

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

}  // namespace

BOOST_AUTO_TEST_CASE(an_unstable_optimum_is_not_handed_out) {
  constexpr double step = 0.0605;  // omega step is nearly pi, where words lose their stability
  const auto [guarded, unguarded] = fits_at(step);
  BOOST_TEST_CONTEXT(guarded.summary.full() << unguarded.summary.full()) {
    // It is found, and said not to be usable.
    BOOST_TEST(!unguarded.summary.usable);
    BOOST_TEST(says(unguarded.summary.reason, "it is not linearly stable at z = 3."));
    BOOST_TEST(largest_half_trace(unguarded, step) > 1.0 + 1e-5);
    BOOST_TEST(unguarded.summary.unguarded.empty());
    // With the guard it is another, and stable.
    BOOST_TEST(guarded.summary.usable);
    BOOST_TEST(guarded.summary.is_held_by_guard);
    BOOST_TEST(guarded.summary.unguarded == unguarded.summary.reason);
    BOOST_TEST(says(guarded.summary.full(), "held by the guard"));
    BOOST_TEST(largest_half_trace(guarded, step) <= 1.0 + rounding);
    BOOST_TEST((guarded.theta - unguarded.theta).norm() > 1e-3);
    BOOST_TEST(guarded.summary.held_out_loss <= guarded.summary.held_out_start_loss);
  }
}

BOOST_AUTO_TEST_CASE(where_the_optimum_is_stable_what_is_handed_out_is_not_worse) {
  for (const double step : {0.04, 0.08}) {
    const auto [guarded, unguarded] = fits_at(step);
    BOOST_TEST_CONTEXT(guarded.summary.full()) {
      BOOST_TEST(unguarded.summary.usable);
      BOOST_TEST(guarded.summary.usable);
      BOOST_TEST(guarded.summary.held_out_loss <= unguarded.summary.held_out_loss);
      BOOST_TEST(largest_half_trace(guarded, step) <= 1.0 + rounding);
    }
  }
}

BOOST_AUTO_TEST_CASE(gaps_between_the_bands_are_told) {
  const auto told = fits_at(0.08).guarded.summary;
  BOOST_REQUIRE(!told.gaps.empty());
  BOOST_TEST(told.gaps[0].low > 0.08 * 5.95);  // above the soft band, below the stiff one
  BOOST_TEST(told.gaps[0].high < 0.08 * 49.0);
  BOOST_TEST(says(told.full(), "which the motion meets rarely or never"));
  BOOST_TEST(fits_at(0.01).guarded.summary.gaps.empty());
}
