// SPDX-License-Identifier: BSL-1.0
// The limits of the guard: frequencies beyond declared bands widen them, and a resonance of two modes is
// refused from a three-fold growth on.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

using namespace nysalt;

namespace {

/// V = q^2/2 + q^4/4, omega^2 = V'' = 1 + 3 q^2, of which only the frequencies 1.5 to 2.5 are declared.
struct stiffening_spring {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * 0.5 + q[0] * q[0] * q[0] * q[0] * 0.25;
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = -q[0] - q[0] * q[0] * q[0];
  }
  std::vector<frequency_band> frequency_bands() const { return {{1.5, 2.5}}; }
};

/// The state whose frequency is omega.
phase_point<double, 1> state_of_frequency(double omega) {
  return {vector<double, 1>(std::sqrt((omega * omega - 1.0) / 3.0)), vector<double, 1>(0.0)};
}

stability_guard guard_along(const std::vector<double>& frequencies) {
  std::vector<phase_point<double, 1>> states;
  for (const double omega : frequencies) states.push_back(state_of_frequency(omega));
  return {stiffening_spring(), states};
}

}  // namespace

// With 2 % more on either side, as of declared bands; f' is exact, so that omega is known to rounding.
BOOST_AUTO_TEST_CASE(a_band_reaches_to_the_highest_frequency_along_the_states) {
  const auto within = guard_along({2.0, 2.4});
  BOOST_TEST(within.frequencies()[0].high == 2.5 * 1.02);
  const auto beyond = guard_along({2.0, 4.0, 3.0});
  BOOST_TEST_REQUIRE(beyond.frequencies().size() == 1U);
  BOOST_TEST(beyond.frequencies()[0].high == 4.0 * 1.02, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(beyond.frequencies()[0].low == 1.5 * 0.98);
  BOOST_TEST(beyond.description().find("along 2 of 3 states") != std::string::npos, beyond.description());
  // z = 2 is the end of the window of Verlet.
  const run_time_word verlet_word("BAB");
  const std::vector<double> c{0.5, 1.0, 0.5};
  BOOST_TEST(within.admits(verlet_word, c, 0.7));
  BOOST_TEST(!beyond.admits(verlet_word, c, 0.7));
  BOOST_TEST(beyond.admits(verlet_word, c, 0.48));
}

namespace {

/// Springs of frequencies 30 and 40 with a soft coupling: impulses at h (30 + 40) = 2 pi are a sum resonance.
stability_guard guard_of_two_modes(std::int64_t steps) {
  const Eigen::Matrix2d stiff{{900.0, 0.0}, {0.0, 1600.0}};
  const Eigen::Matrix2d soft{{0.0, 0.9}, {0.9, 0.0}};
  const linear_chain chain(stiff + soft, Eigen::Vector2d(1.0, 1.0));
  const std::vector<phase_point<double, Eigen::Dynamic>> states(
      1, {Eigen::VectorXd::Zero(2), Eigen::VectorXd::Zero(2)});
  return {with_quadratic_part(chain, stiff), states, true, steps};
}

}  // namespace

// The logarithm of the growth rises with the number of steps: the words of the objection stand where it is
// above log 3 = 1.0986, which is checked below it, and between it and 3.
BOOST_AUTO_TEST_CASE(a_pair_of_modes_is_refused_from_a_threefold_growth_on) {
  const run_time_word impulses("RSR");
  const std::vector<double> halves{0.5, 1.0, 0.5};
  const double step = 2.0 * 3.14159265358979 / 70.0;
  constexpr std::int64_t many = 100'000;
  const double of_one_step =
      guard_of_two_modes(many).most_resonant(impulses, halves, step).growth / static_cast<double>(many);
  BOOST_TEST_REQUIRE(of_one_step > 0.0);
  const auto said = [&](double growth) {
    const auto steps = static_cast<std::int64_t>(growth / of_one_step);
    return guard_of_two_modes(steps).objection(impulses, halves, step);
  };
  BOOST_TEST(said(1.0).find("is near a resonance") == std::string::npos, said(1.0));
  BOOST_TEST(said(2.0).find("is near a resonance") != std::string::npos, said(2.0));
}
