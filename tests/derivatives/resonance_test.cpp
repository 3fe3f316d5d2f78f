// SPDX-License-Identifier: BSL-1.0
// How near a step is to a resonance of a stiff band, and which steps are not.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../support/draws.hpp"
#include "nysalt/derivatives/stability_margin.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The least distance of h omega from k pi, relative to it, over the band: from 200 frequencies.
double distance_by_search(const frequency_band& band, double step) {
  double least = 1.0;
  for (int i = 0; i <= 200; ++i) {
    const double turns = step * (band.low + (band.high - band.low) * i / 200.0) / std::numbers::pi;
    for (int k = 1; k < 40; ++k) least = std::min(least, std::abs(turns / k - 1.0));
  }
  return least;
}

}  // namespace

BOOST_AUTO_TEST_CASE(near_means_within_a_tenth) {
  draws random;
  for (int n = 0; n < 300; ++n) {
    const double low = random.uniform(10.0, 60.0);
    const frequency_band band{low, low * random.uniform(1.0, 1.3)};
    const double step = random.uniform(0.01, 0.4);
    const double distance = distance_by_search(band, step);
    if (std::abs(distance - resonance_distance) < 2e-3) continue;  // what 200 frequencies do not resolve
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", band " << band.low << " to " << band.high << ", step "
                               << step) {
      BOOST_TEST(near_resonance({band}, step).has_value() == (distance < resonance_distance));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_steps_that_are_named_are_far_from_that_resonance) {
  const frequency_band narrow{49.0, 51.0};
  const auto near = near_resonance({{0.0, 6.0}, narrow}, 0.118);
  BOOST_TEST_REQUIRE(near.has_value());
  BOOST_TEST(near->half_turns == 2);
  BOOST_TEST(!near_resonance({narrow}, 0.999 * near->near.low));
  BOOST_TEST(!near_resonance({narrow}, 1.001 * near->near.high));
  BOOST_TEST(near_resonance({narrow}, 1.001 * near->near.low).has_value());
  BOOST_TEST(near_resonance({narrow}, 0.999 * near->near.high).has_value());
  const std::string text = in_words(*near);
  BOOST_TEST(text.find("2 pi") != std::string::npos);
  BOOST_TEST(text.find("10 %") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(slow_motion_has_none) {
  BOOST_TEST(!near_resonance({{0.0, 30.0}}, std::numbers::pi / 30.0));
  BOOST_TEST(!near_resonance({{49.0, 51.0}}, 0.01));
  BOOST_TEST(!near_resonance({}, 1.0));
}
