// SPDX-License-Identifier: BSL-1.0
// How far an energy may go before a trajectory counts as lost, in a bath and without.
#include "nysalt/detail/divergence.hpp"

#include <boost/test/unit_test.hpp>

#include <limits>

#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "support/systems.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// A state of that energy, K = p^2/2 alone.
phase_point<double, 1> with_energy(double energy) {
  return {vector<double, 1>(0.0), vector<double, 1>(std::sqrt(2.0 * energy))};
}

/// Whether the bound lies at 1e3 times the scale, to a part in a thousand.
template <System S>
bool has_scale(const S& system, double scale, double start = 0.0) {
  const divergence diverged(system, with_energy(start));
  return !diverged(with_energy(start + 0.999e3 * scale)) && diverged(with_energy(start + 1.001e3 * scale));
}

const harmonic_oscillator alone(1.0);
in_bath<harmonic_oscillator> in(const bath& heat_bath) { return {alone, heat_bath}; }

}  // namespace

BOOST_AUTO_TEST_CASE(the_scale_is_the_energy_at_the_start_or_one) {
  BOOST_TEST(has_scale(alone, 1.0));
  BOOST_TEST(has_scale(alone, 7.0, 7.0));
  BOOST_TEST(!has_scale(alone, 7.0));
}

BOOST_AUTO_TEST_CASE(in_a_bath_the_scale_is_at_least_that_of_all_degrees_of_freedom) {
  BOOST_TEST(has_scale(in(bath::of_temperature(0.1, 5.0)), 5.0));
  BOOST_TEST(has_scale(in(bath::of_temperature(0.1, 5.0)), 7.0, 7.0));
  BOOST_TEST(has_scale(in(bath::of_temperature(0.1, 0.2)), 1.0));
  BOOST_TEST(has_scale(in(bath::of_sigma(0.5, 3.0)), 9.0));  // kT = sigma^2/(2 gamma)
  BOOST_TEST(!has_scale(in(bath::of_temperature(0.1, 5.0)), 1.0));
  const in_bath<dynamic_potential> many({.masses = 4}, bath::of_temperature(0.1, 5.0));
  const auto at = [&](double p) {
    return phase_point<double, Eigen::Dynamic>{vector<double, Eigen::Dynamic>::Zero(4),
                                               vector<double, Eigen::Dynamic>::Constant(4, p)};
  };
  const divergence diverged(many, at(0.0));  // 4 p^2/2 against 1e3 4 kT
  BOOST_TEST(!diverged(at(std::sqrt(0.999e3 * 10.0))));
  BOOST_TEST(diverged(at(std::sqrt(1.001e3 * 10.0))));
}

BOOST_AUTO_TEST_CASE(a_bath_that_does_not_act_changes_nothing) {
  BOOST_TEST(has_scale(in(bath::of_sigma(0.0, 0.0)), 1.0));
  BOOST_TEST(has_scale(in(bath::of_sigma(0.1, 0.0)), 1.0));
}

// Noise without friction: the energy grows for ever, and rightly so. Only what is not finite is lost.
BOOST_AUTO_TEST_CASE(a_bath_that_heats_has_no_bound) {
  const auto heated = in(bath::of_sigma(0.0, 1.0));
  const divergence diverged(heated, with_energy(0.0));
  BOOST_TEST(!diverged(with_energy(1e100)));
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    auto x = with_energy(1.0);
    x.q[0] = bad;
    BOOST_TEST(diverged(x));
  }
}

BOOST_AUTO_TEST_CASE(each_lane_has_its_own_bound) {
  using T = pack<double, 2>;
  const auto warm = in(bath::of_temperature(0.1, 5.0));
  const auto both_at = [](double first, double second) {
    auto x = with_energy(first).cast<T>();
    set_lane(x, 1, with_energy(second));
    return x;
  };
  const divergence<in_bath<harmonic_oscillator>, T> diverged(warm, both_at(0.0, 7.0));
  const auto at = diverged(both_at(6000.0, 6000.0));
  BOOST_TEST(at[0]);
  BOOST_TEST(!at[1]);
}
