// SPDX-License-Identifier: BSL-1.0
// The least ensemble, reference and observer: what docs/concepts shows, and that they do their work.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "nysalt/ensemble.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "quartic_well.hpp"

using namespace nysalt::test;

namespace {

constexpr double eps = 0x1p-52;

// [reference]
/// Of the oscillator of frequency 1 the flow is a rotation.
struct quarter_turns {
  void advance(const nysalt::harmonic_oscillator&, nysalt::phase_point<double, 1>& x, double t) const {
    const double q = x.q[0];
    x.q[0] = std::cos(t) * q + std::sin(t) * x.p[0];
    x.p[0] = std::cos(t) * x.p[0] - std::sin(t) * q;
  }
  quarter_turns finer() const { return *this; }
  std::string description() const { return "the exact rotation"; }
};
static_assert(nysalt::Reference<quarter_turns, nysalt::harmonic_oscillator>);
// [/reference]
static_assert(!nysalt::Reference<quarter_turns, quartic_well>);

// [ensemble]
/// One after the other on the unit circle, a golden section of it apart; the seed turns all.
struct around_the_circle {
  nysalt::phase_point<double, 1> operator()(std::uint64_t seed, std::uint64_t n) const {
    const double turns =
        static_cast<double>(seed) * std::numbers::sqrt2 + static_cast<double>(n) * std::numbers::phi;
    const double angle = 2.0 * std::numbers::pi * (turns - std::floor(turns));
    return {nysalt::vector<double, 1>(std::cos(angle)), nysalt::vector<double, 1>(std::sin(angle))};
  }
  std::string description() const { return "around_the_circle()"; }
};
static_assert(nysalt::Ensemble<around_the_circle, nysalt::harmonic_oscillator>);
// [/ensemble]
static_assert(!nysalt::Ensemble<quarter_turns, nysalt::harmonic_oscillator>);

}  // namespace

BOOST_AUTO_TEST_CASE(a_reference_and_an_ensemble_of_ones_own) {
  const nysalt::harmonic_oscillator system(1.0);
  const quarter_turns exact;
  const around_the_circle starts;
  const auto start = nysalt::sound_start(system, starts, 1, 5);
  BOOST_TEST(std::abs(start.q[0] * start.q[0] + start.p[0] * start.p[0] - 1.0) <= 8 * eps);
  BOOST_TEST(start.q[0] != starts(2, 5).q[0]);
  BOOST_TEST(nysalt::reference_error(system, exact, start, 3.0) == 0.0);
  auto x = start;
  exact.advance(system, x, std::numbers::pi / 2.0);
  BOOST_TEST(std::abs(x.q[0] - start.p[0]) <= 4 * eps);
}

BOOST_AUTO_TEST_CASE(an_observer_sees_synchronous_states_in_time) {
  const nysalt::harmonic_oscillator system(1.0);
  // [observer]
  double largest = 0.0;
  const auto watch = [&](std::int64_t /*n*/, double /*t*/, const nysalt::phase_point<double, 1>& x) {
    largest = std::max(largest, std::abs(x.q[0]));
  };
  nysalt::integrate(system, nysalt::verlet(), 0.1, at(0.0, 1.0), 1000, watch, 10);
  // [/observer]
  // Verlet keeps q^2 (1 - z^2/4) + p^2: the largest q lies below 1/sqrt(1 - z^2/4), and near it.
  BOOST_TEST(largest < 1.0 / std::sqrt(1.0 - 0.0025) + 1e-12);
  BOOST_TEST(largest > 0.99);
}
