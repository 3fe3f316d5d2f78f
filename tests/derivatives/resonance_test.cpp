// SPDX-License-Identifier: BSL-1.0
// How near the steps of a word are to half turns of a stiff oscillation.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "nysalt/derivatives/near_resonance.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"

using namespace nysalt;

namespace {

constexpr double pi = std::numbers::pi;

std::optional<resonance> near(const tabulated& method, const std::vector<frequency_band>& bands,
                              double step) {
  return near_resonance(method.letters(), method.coefficients(), bands, step);
}

/// Position Verlet in that many equal steps, whose phase at z is 2 n asin(z/(2 n)).
tabulated many_steps(int n) {
  std::string letters = "A";
  std::vector<double> c{0.5 / n};
  for (int k = 0; k < n; ++k) {
    letters += "BA";
    c.push_back(1.0 / n);
    c.push_back(k + 1 < n ? 1.0 / n : 0.5 / n);
  }
  return {"verlet", run_time_word(letters), c, {2, true, false}};
}

}  // namespace

// Sixty-four steps turn by z to within z^3/(24 n^2), 0.3 % at 2 pi.
BOOST_AUTO_TEST_CASE(near_means_within_a_tenth_of_the_half_turns) {
  const tabulated method = many_steps(64);
  for (const int k : {1, 2}) {
    for (const double off : {-0.12, -0.09, -0.05, 0.0, 0.05, 0.09, 0.12}) {
      const double step = (1.0 + off) * k * pi / 50.0;
      const auto found = near(method, {{0.0, 6.0}, {50.0, 50.0}}, step);
      BOOST_TEST(found.has_value() == (std::abs(off) < 0.1), k << " pi, off by " << off);
      if (found) BOOST_TEST(found->half_turns == k);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_band_is_near_where_one_of_its_frequencies_is) {
  const tabulated method = many_steps(64);
  BOOST_TEST(near(method, {{40.0, 50.0}}, 0.95 * pi / 40.0).has_value());
  BOOST_TEST(near(method, {{40.0, 50.0}}, 0.95 * pi / 50.0).has_value());
  BOOST_TEST(!near(method, {{40.0, 50.0}}, 0.85 * pi / 50.0));
}

// Verlet in two steps turns by 3.6 where h omega is pi: the step of another motion, as that of one Verlet
// step of half the length.
BOOST_AUTO_TEST_CASE(what_counts_is_the_phase_of_the_word) {
  BOOST_TEST(!near(many_steps(2), {{50.0, 50.0}}, pi / 50.0));
  BOOST_TEST(near(many_steps(64), {{50.0, 50.0}}, pi / 50.0).has_value());
}

BOOST_AUTO_TEST_CASE(slow_motion_and_rotations_have_none) {
  BOOST_TEST(!near(many_steps(64), {{0.0, 30.0}}, pi / 30.0));
  BOOST_TEST(!near(many_steps(64), {{49.0, 51.0}}, 0.01));
  BOOST_TEST(!near(many_steps(64), {}, 1.0));
  BOOST_TEST(!near(tabulated(impulse{}), {{50.0, 50.0}}, pi / 50.0));
}

BOOST_AUTO_TEST_CASE(in_words_it_says_which) {
  const std::string text = in_words(*near(many_steps(64), {{49.0, 51.0}}, 0.118));
  BOOST_TEST(text.find("2 pi") != std::string::npos);
  BOOST_TEST(text.find("10 %") != std::string::npos);
  BOOST_TEST(text.find("49 to 51") != std::string::npos);
}
