// SPDX-License-Identifier: BSL-1.0
// The guard admits what is stable on the frequencies of a system, and nothing else; where the best of a
// family is unstable, another one is handed out. More steps: long/learning/verdict_test.
#include "nysalt/learning/stability_guard.hpp"

#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/learned.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// With windows 0 .. sqrt(20/3) and sqrt(10) .. sqrt(50/3), and a gap between.
const nysalt::word two_stages("ABABA");
std::vector<double> with_a_gap() {
  const auto c = nystrom::coefficients(std::array{0.5, 0.4});
  return {c.begin(), c.end()};
}

const nysalt::word verlet_word("BAB");
const std::vector<double> verlet_coefficients{0.5, 1.0, 0.5};

const std::vector<phase_point<double, 1>> no_states;

detail::stability_guard guard_of_one() { return {harmonic_oscillator(1.0), no_states}; }

/// A fast oscillator whose stiffness a slow one switches.
struct two_stiffnesses {
  static constexpr int dimension = 2;
  void force(const vector<double, 2>& q, vector<double, 2>& f) const {
    f[0] = -q[0];
    f[1] = -(650.0 + 250.0 * std::tanh(1e3 * q[0])) * q[1];
  }
  void force_derivative(const vector<double, 2>& q, const vector<double, 2>& v, vector<double, 2>& g) const {
    g[0] = -v[0];
    g[1] = -(650.0 + 250.0 * std::tanh(1e3 * q[0])) * v[1];
  }
};

const fpu_chain<3> chain(50.0);

/// The paper's initial states.
std::vector<phase_point<double, 6>> states_of_chain(std::uint64_t count) {
  const fpu_law<3> law(chain);
  std::vector<phase_point<double, 6>> states;
  for (std::uint64_t n = 0; n < count; ++n) states.push_back(law(1, n));
  return states;
}

/// The force of the FPU chain, which declares nothing.
struct undeclared_chain {
  static constexpr int dimension = 6;
  template <class T>
  void force(const vector<T, 6>& q, vector<T, 6>& f) const {
    chain.force(q, f);
  }
};

/// V = q^2/2 + q^4/4, omega^2 = V'' = 1 + 3 q^2, of which only the frequencies 1.5 to 2.5 are declared.
struct stiffening_spring {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * 0.5 + q[0] * q[0] * q[0] * q[0] * 0.25;
  }
  std::vector<frequency_band> frequency_bands() const { return {{1.5, 2.5}}; }
};

detail::stability_guard guard_along(const std::vector<double>& frequencies) {
  std::vector<phase_point<double, 1>> states;
  for (const double omega : frequencies) {
    states.push_back({vector<double, 1>(std::sqrt((omega * omega - 1.0) / 3.0)), vector<double, 1>(0.0)});
  }
  return {stiffening_spring(), states};
}

/// The FPU chain of omega = 50 with its stiff springs split off, along the paper's initial states.
detail::stability_guard guard_of_rotations(std::int64_t steps = 10'000) {
  Eigen::MatrixXd stiff = Eigen::MatrixXd::Zero(6, 6);
  for (Eigen::Index i = 0; i < 6; i += 2) {
    stiff.block<2, 2>(i, i) = 1250.0 * Eigen::Matrix2d{{1.0, -1.0}, {-1.0, 1.0}};
  }
  return {with_quadratic_part(chain, stiff), states_of_chain(20), true, steps};
}

/// Springs of frequencies 30 and 40 with a soft coupling: impulses at h (30 + 40) = 2 pi are a sum resonance.
detail::stability_guard guard_of_two_modes(std::int64_t steps) {
  const Eigen::Matrix2d stiff{{900.0, 0.0}, {0.0, 1600.0}};
  const Eigen::Matrix2d soft{{0.0, 0.9}, {0.9, 0.0}};
  const linear_chain chain(stiff + soft, Eigen::Vector2d(1.0, 1.0));
  const std::vector<phase_point<double, Eigen::Dynamic>> states(
      1, {Eigen::VectorXd::Zero(2), Eigen::VectorXd::Zero(2)});
  return {with_quadratic_part(chain, stiff), states, true, steps};
}

const nysalt::word one_impulse("RSR");
const std::vector<double> halves{0.5, 1.0, 0.5};
const double resonance = std::numbers::pi / 50.0;

const family four_kicks{aba<4>()};

/// From equal steps alone: of all that the family would begin with, one finds stable words.
fit fitted_at(double step, bool guarded) {
  const data_options options{.step = step, .horizon = 10.0 * step, .trajectories = 50};
  return data_sets(chain, fpu_law<3>(chain), fine_steps(step / 60.0), options)
      .learned(four_kicks, chain,
               {.loss = loss_named("state:1"),
                .start = four_kicks.starts[0].theta,
                .random_starts = 0,
                .guarded = guarded,
                .planned_steps = 2000});
}

/// The largest |trace|/2 of a step on oscillators within the chain's bands: above 1 they grow.
double largest_half_trace(const fit& found) {
  double largest = 0.0;
  for (const auto& band : chain.frequency_bands()) {
    for (int n = 0; n <= 500; ++n) {
      const double omega = std::max(1e-3, band.low + (band.high - band.low) * n / 500.0);
      const auto m = detail::matrix_on_oscillator(four_kicks.letters, four_kicks.coefficients(found.theta),
                                                  std::pow(omega * found.summary.step, 2));
      largest = std::max(largest, std::abs(m.half_trace()));
    }
  }
  return largest;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_band_is_asked_with_two_percent_on_either_side) {
  const auto guard = guard_of_one();
  BOOST_TEST(guard.description() == "declared bands [0.98, 1.02]");
  const auto c = with_a_gap();
  const double end = std::sqrt(20.0 / 3.0);
  const double again = std::sqrt(10.0);
  const double last = std::sqrt(50.0 / 3.0);
  for (const double step : {0.1, 0.999 * end / 1.02, 1.001 * again / 0.98, 0.999 * last / 1.02}) {
    BOOST_TEST(guard.admits(two_stages, c, step), step);
  }
  for (const double step : {1.001 * end / 1.02, 2.9, 0.999 * again / 0.98, 1.001 * last / 1.02}) {
    BOOST_TEST(!guard.admits(two_stages, c, step), step);
  }
  const auto said = guard.objection(two_stages, c, 2.9);
  for (const char* words : {"not linearly stable", "z = 2.842", "0.98 to 1.02"}) {
    BOOST_TEST(says(said, words), said << " lacks " << words);
  }
}

// With 2 % more on either side, as of declared bands; f' is exact, so that omega is known to rounding.
BOOST_AUTO_TEST_CASE(a_band_reaches_to_the_highest_frequency_along_the_states) {
  const auto within = guard_along({2.0, 2.4});
  BOOST_TEST(within.frequencies()[0].high == 2.5 * 1.02);
  const auto beyond = guard_along({2.0, 4.0, 3.0});
  BOOST_TEST_REQUIRE(beyond.frequencies().size() == 1U);
  BOOST_TEST(beyond.frequencies()[0].high == 4.0 * 1.02, tolerance(1e-6));
  BOOST_TEST(beyond.frequencies()[0].low == 1.5 * 0.98);
  BOOST_TEST(says(beyond.description(), "along 2 of 3 states"), beyond.description());
  // z = 2 is the end of the window of Verlet.
  BOOST_TEST(within.admits(verlet_word, verlet_coefficients, 0.7));
  BOOST_TEST(!beyond.admits(verlet_word, verlet_coefficients, 0.7));
  BOOST_TEST(beyond.admits(verlet_word, verlet_coefficients, 0.48));
}

// What is outside the bands may be unstable, and is told.
BOOST_AUTO_TEST_CASE(gaps_below_the_highest_frequency_are_told) {
  const auto guard = guard_of_one();
  const double step = 3.5;
  BOOST_TEST(guard.admits(two_stages, with_a_gap(), step));
  const auto gaps = guard.gaps(two_stages, with_a_gap(), step);
  BOOST_REQUIRE(gaps.size() == 1U);
  BOOST_TEST(std::abs(gaps[0].low - std::sqrt(20.0 / 3.0)) < 1e-12);
  BOOST_TEST(std::abs(gaps[0].high - std::sqrt(10.0)) < 1e-12);
  for (const double part : {0.001, 0.5, 0.999}) {
    const double z = gaps[0].low + part * (gaps[0].high - gaps[0].low);
    const auto m = detail::matrix_on_oscillator(two_stages, with_a_gap(), z * z);
    BOOST_TEST(spectral_radius(Eigen::Matrix2d{{m.qq, m.qp}, {m.pq, m.pp}}) > 1.001);
  }
  BOOST_TEST(guard.gaps(two_stages, with_a_gap(), 2.0).empty());
  const auto beyond = guard.gaps(verlet_word, verlet_coefficients, 3.0);
  BOOST_REQUIRE(beyond.size() == 1U);
  BOOST_TEST(std::abs(beyond[0].low - 2.0) < 1e-12);
  BOOST_TEST(beyond[0].high == 3.0 * 1.02);
}

BOOST_AUTO_TEST_CASE(where_no_band_is_declared_the_states_tell) {
  draws random;
  const dynamic_potential ring{4};
  std::vector<phase_point<double, Eigen::Dynamic>> states;
  double stiffest = 0.0;
  for (int n = 0; n < 20; ++n) {
    states.push_back(random.state(ring, 0.8));
    const Eigen::MatrixXd a = hessian(ring, states.back().q);
    stiffest = std::max(stiffest, symmetric_eigen(a).values[3]);
  }
  const detail::stability_guard guard(ring, states);
  BOOST_TEST(guard.description().find("estimated 0..") == 0U);
  BOOST_TEST(says(guard.description(), "along 20 states"));
  const double highest = 1.02 * std::sqrt(stiffest);
  BOOST_TEST(std::abs(guard.frequencies()[0].high - highest) < 1e-9);
  BOOST_TEST(guard.admits(verlet_word, verlet_coefficients, 1.999 / highest));
  BOOST_TEST(!guard.admits(verlet_word, verlet_coefficients, 2.001 / highest));
  // In its second window this word would pass if the highest frequency were all that counts.
  BOOST_TEST(!guard.admits(two_stages, with_a_gap(), 3.5 / highest));
}

// Soft bonds of energies below 2 have frequencies up to 5.8, and stiff ones between 50 and 50.4.
BOOST_AUTO_TEST_CASE(undeclared_frequencies_that_lie_far_apart_are_bands) {
  const detail::stability_guard guard(undeclared_chain{}, states_of_chain(200));
  const auto& bands = guard.frequencies();
  BOOST_TEST_CONTEXT(guard.description()) {
    BOOST_REQUIRE(bands.size() == 2U);
    BOOST_TEST(bands[0].low == 0.0);
    BOOST_TEST(bands[0].high < 10.0);
    BOOST_TEST(48.0 < bands[1].low);
    BOOST_TEST(bands[1].high < 53.0);
    BOOST_TEST(guard.frequencies(detail::met::often).size() == 2U);
  }
  // Unstable between z = 2.58 and 3.16: the stiff band may lie beyond, but not within.
  BOOST_TEST(guard.admits(two_stages, with_a_gap(), 3.5 / 50.0));
  BOOST_TEST(!guard.admits(two_stages, with_a_gap(), 2.9 / 50.0));
  const detail::stability_guard of_few(undeclared_chain{},
                                       states_of_chain(20));  // too few to tell what is not met
  BOOST_TEST(of_few.frequencies().size() == 1U);
  BOOST_TEST(!of_few.admits(two_stages, with_a_gap(), 3.5 / 50.0));
}

// The fast frequency is 20 or 30, and passes through all between them, though no state has one of these.
BOOST_AUTO_TEST_CASE(what_one_frequency_passes_through_is_one_band) {
  std::vector<phase_point<double, 2>> states;
  for (int n = 0; n < 100; ++n) states.push_back({{n % 2 == 0 ? 1.0 : -1.0, 0.0}, {0.0, 1.0}});
  const detail::stability_guard guard(two_stiffnesses{}, states);
  BOOST_TEST_CONTEXT(guard.description()) {
    BOOST_REQUIRE(guard.frequencies().size() == 2U);
    BOOST_TEST(guard.frequencies()[1].low < 20.0);
    BOOST_TEST(guard.frequencies()[1].high > 30.0);
  }
}

BOOST_AUTO_TEST_CASE(coefficients_that_are_none_are_not_admitted) {
  const auto guard = guard_of_one();
  BOOST_TEST(!guard.admits(verlet_word, {0.5, not_a_number, 0.5}, 0.1));
  BOOST_TEST(!guard.admits(verlet_word, {0.5, 1e200, 1e200}, 0.1));
  BOOST_TEST(refuses([&] { guard.admits(verlet_word, {0.5, 1.0}, 0.1); }, {"BAB", "2 coefficients"}));
}

BOOST_AUTO_TEST_CASE(impulses_are_refused_at_resonances_alone) {
  const auto guard = guard_of_rotations();
  BOOST_TEST(says(guard.description(), "2 modes under soft forces"), guard.description());
  for (const double at : {1.0, 2.0, 3.0}) {
    BOOST_TEST_CONTEXT("h omega = " << at << " pi") {
      const auto said = guard.objection(one_impulse, halves, at * resonance);
      BOOST_TEST(says(said, "magnifies the mode of frequency 50"), said);
      BOOST_TEST(guard.admits(one_impulse, halves, (at - 0.1) * resonance));
      BOOST_TEST(guard.admits(one_impulse, halves, (at + 0.1) * resonance));
    }
  }
  // Of the two modes the stiff one is magnified, and beside the resonance none.
  const auto most = guard.most_magnified(one_impulse, halves, resonance);
  BOOST_TEST(std::abs(most.frequency - 50.0) < 1e-9);
  BOOST_TEST(most.factor > 3.0);
  const auto first = guard.most_magnified(one_impulse, halves, resonance, 1.5);
  BOOST_TEST(first.factor > 1.5);
  BOOST_TEST(first.factor <= most.factor);
  BOOST_TEST(guard.most_magnified(one_impulse, halves, 0.9 * resonance).factor <= 3.0);
  // In ten steps nothing comes of it.
  BOOST_TEST(guard_of_rotations(10).admits(one_impulse, halves, resonance));
  // The soft modes make it unstable themselves: h sqrt(kappa) > 2.
  BOOST_TEST(!guard.admits(one_impulse, halves, 12.3 * resonance));
  BOOST_TEST(guard.gaps(one_impulse, halves, resonance).empty());
  // Steps of words without rotations are bounded by the stiff springs all the same.
  BOOST_TEST(guard.admits(verlet_word, verlet_coefficients, 1.9 / 51.4));
  BOOST_TEST(!guard.admits(verlet_word, verlet_coefficients, 2.0 / 50.0));
}

// The logarithm of the growth rises with the number of steps: the words of the objection stand where it is
// above log 3 = 1.0986, which is checked below it, and between it and 3.
BOOST_AUTO_TEST_CASE(a_pair_of_modes_is_refused_from_a_threefold_growth_on) {
  const double step = 2.0 * std::numbers::pi / 70.0;
  constexpr std::int64_t many = 100'000;
  const double of_one_step =
      guard_of_two_modes(many).most_resonant(one_impulse, halves, step).growth / static_cast<double>(many);
  BOOST_TEST_REQUIRE(of_one_step > 0.0);
  const auto said = [&](double growth) {
    const auto steps = static_cast<std::int64_t>(growth / of_one_step);
    return guard_of_two_modes(steps).objection(one_impulse, halves, step);
  };
  BOOST_TEST(!says(said(1.0), "is near a resonance"), said(1.0));
  BOOST_TEST(says(said(2.0), "is near a resonance"), said(2.0));
}

// Four kicks, learned at h omega = pi by the one-step loss: at T = 100 its error of the stiff energy is 1 %,
// that of impulses 24-fold.
BOOST_AUTO_TEST_CASE(what_was_learned_at_a_resonance_is_admitted_there) {
  const auto guard = guard_of_rotations();
  const nysalt::word word("RSRSRSRSR");
  const std::vector<double> c{0.09004278, 0.22513766, 0.28760145, 0.27486234, 0.24471153,
                              0.27486234, 0.28760145, 0.22513766, 0.09004278};
  BOOST_TEST(guard.objection(word, c, resonance).empty(), guard.objection(word, c, resonance));
  // Four impulses in a row are no better than one by one.
  const std::vector<double> impulses{0.125, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.125};
  BOOST_TEST(!guard.admits(word, impulses, 4.0 * resonance));
}

// What is learned without data has no states: then only bands tell.
BOOST_AUTO_TEST_CASE(without_states_only_bands_tell) {
  const with_quadratic_part system(harmonic_oscillator(1.0), Eigen::MatrixXd::Identity(1, 1));
  const detail::stability_guard guard(system, no_states);
  BOOST_TEST(guard.description() == "declared bands [0.98, 1.02]");
  BOOST_TEST(guard.admits(one_impulse, halves, 3.0));
  BOOST_TEST(!guard.admits(verlet_word, verlet_coefficients, 3.0));
  BOOST_TEST(
      refuses([&] { detail::stability_guard(potential_only(), std::vector<phase_point<double, 2>>()); },
              {"or states given"}));
  const detail::stability_guard none(relativistic{}, no_states);  // its kinetic energy is not quadratic
  BOOST_TEST(none.description().find("no linear criterion") == 0U);
  BOOST_TEST(none.admits(verlet_word, verlet_coefficients, 1e6));
  BOOST_TEST(none.gaps(verlet_word, verlet_coefficients, 1e6).empty());
}

BOOST_AUTO_TEST_CASE(an_unstable_optimum_is_not_handed_out) {
  constexpr double step = 0.0605;  // omega step is nearly pi, where words lose their stability
  const fit guarded = fitted_at(step, true);
  const fit unguarded = fitted_at(step, false);
  BOOST_TEST_CONTEXT(guarded.summary.full() << unguarded.summary.full()) {
    // It is found, and said not to be usable.
    BOOST_TEST(!unguarded.summary.usable);
    BOOST_TEST(says(unguarded.summary.reason, "loses trajectories: "));
    BOOST_TEST(says(unguarded.summary.judgement.linear_objection, "it is not linearly stable at z = 3."));
    BOOST_TEST(largest_half_trace(unguarded) > 1.0 + 1e-5);
    BOOST_TEST(unguarded.summary.unguarded.empty());
    // With the guard it is another, and stable.
    BOOST_TEST(guarded.summary.usable);
    BOOST_TEST(guarded.summary.is_held_by_guard);
    BOOST_TEST(guarded.summary.unguarded == unguarded.summary.judgement.linear_objection);
    BOOST_TEST(says(guarded.summary.full(), "held by the guard"));
    // What the guard calls rounding, and some 20 of entries that nine letters may magnify to some 50.
    BOOST_TEST(largest_half_trace(guarded) <= 1.0 + 1e-10 + 20.0 * 50.0 * eps);
    BOOST_TEST((guarded.theta - unguarded.theta).norm() > 1e-3);
    BOOST_TEST(guarded.summary.held_out_loss <= guarded.summary.held_out_start_loss);
  }
}

BOOST_AUTO_TEST_CASE(the_summary_tells_gaps_between_the_bands) {
  const auto told = fitted_at(0.08, true).summary;
  BOOST_TEST(told.usable, told.reason);
  BOOST_REQUIRE(!told.gaps.empty());
  BOOST_TEST(told.gaps[0].low > 0.08 * 5.95);  // above the soft band, below the stiff one
  BOOST_TEST(told.gaps[0].high < 0.08 * 49.0);
  BOOST_TEST(says(told.full(), "which the motion meets rarely or never"));
  BOOST_TEST(fitted_at(0.01, true).summary.gaps.empty());
  // Where the optimum is stable, what is handed out is not worse.
  const auto unguarded = fitted_at(0.08, false).summary;
  BOOST_TEST(unguarded.usable, unguarded.reason);
  BOOST_TEST(told.held_out_loss <= unguarded.held_out_loss);
}
