// SPDX-License-Identifier: BSL-1.0
// Units of Hybrid Monte Carlo: durations, kT, masses of coordinates, and the numbers of refused starts.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "../support/refusal.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/hmc.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

vector<double, 1> number(double x) { return vector<double, 1>(x); }

normal_around<1> around_zero(double deviation) { return {{number(0.0), number(0.0)}, deviation, 1.0}; }

/// Nothing acts: each proposal is accepted, and moves q by p T.
struct free_particle {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>&) const {
    return T(0.0);
  }
  template <class T>
  void force(const vector<T, 1>&, vector<T, 1>& f) const {
    f[0] = T(0.0);
  }
};

/// V = 20 (q^2 - 1)^2: between the wells at -1 and 1 stands a barrier of 20.
struct two_wells {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    const T y = q[0] * q[0] - 1.0;
    return y * y * 20.0;
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = (1.0 - q[0] * q[0]) * q[0] * 80.0;
  }
};

/// V = 1/q^2, which is not finite at q = 0.
struct wall {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return T(1.0) / (q[0] * q[0]);
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = T(2.0) / (q[0] * q[0] * q[0]);
  }
};

const auto ignored = [](const hmc_draw&) {};

}  // namespace

// Momenta are those of unit mass and kT = 1: over 2000 chains the mean square of a move is T^2 to 3 % (one
// standard error, sqrt(2/2000)). T is uniform in 0 .. 2: of 40 the mean is 1 to 0.09, here within four such
// errors.
BOOST_AUTO_TEST_CASE(durations_are_uniform_up_to_twice_the_length) {
  constexpr std::int64_t chains = 2000;
  constexpr std::int64_t draws = 40;
  std::vector<std::vector<double>> q(chains, std::vector<double>(draws));
  const hmc_options options{.step = 0.01, .length = 1.0, .chains = chains, .burn_in = 0, .draws = draws};
  const auto result =
      hmc(free_particle(), tabulated(verlet{}), around_zero(0.0), options, [&](const hmc_draw& draw) {
        q[static_cast<std::size_t>(draw.chain)][static_cast<std::size_t>(draw.number)] = draw.q[0];
      });
  BOOST_TEST(result.acceptance.mean == 1.0);
  std::vector<double> durations;
  double mean = 0.0;
  for (std::size_t n = 0; n < draws; ++n) {
    double square = 0.0;
    for (const auto& chain : q) square += std::pow(chain[n] - (n > 0 ? chain[n - 1] : 0.0), 2.0) / chains;
    durations.push_back(std::sqrt(square));
    mean += durations.back() / draws;
  }
  BOOST_TEST(std::abs(mean - 1.0) < 0.36);
  BOOST_TEST(std::ranges::min(durations) < 0.5);  // of 40 all above 0.5: once in 100,000
  BOOST_TEST(std::ranges::max(durations) > 1.5);
  BOOST_TEST(std::ranges::max(durations) < 2.2);  // 2, with four errors
  // A step of Verlet is one evaluation, and one more opens the trajectory.
  BOOST_TEST(result.evaluations_of_draw - 1.0 == 100.0 * mean, boost::test_tools::tolerance(0.03));
}

// With kT/var(q) as masses all numbers scale with kT, by a power of two without rounding: the step, which is
// in units of the masses, has the same bits.
BOOST_AUTO_TEST_CASE(with_masses_the_step_does_not_depend_on_the_temperature) {
  const auto at = [](double deviation) {
    return hmc(harmonic_oscillator(3.0), tabulated(verlet{}), around_zero(deviation),
               {.step = 0.1,
                .length = 1.5,
                .temperature = deviation * deviation,
                .chains = 8,
                .burn_in = 200,
                .draws = 10,
                .acceptance = 0.9,
                .diagonal_masses = true},
               ignored);
  };
  const auto cold = at(1.0);
  const auto hot = at(4.0);
  BOOST_TEST(cold.step == hot.step);
  BOOST_TEST_REQUIRE(cold.deviations.size() == 1U);
  BOOST_TEST(hot.deviations[0] == 4.0 * cold.deviations[0]);
  BOOST_TEST(std::abs(cold.deviations[0] - 1.0 / 3.0) < 0.1);  // sqrt(kT)/omega
}

// No chain leaves its well, and half of them are in each: the variance is 1 between chains, 1/160 within.
BOOST_AUTO_TEST_CASE(masses_know_the_variance_between_chains) {
  std::vector<phase_point<double, 1>> starts;
  for (int m = 0; m < 8; ++m) starts.push_back({number(m % 2 == 0 ? 1.0 : -1.0), number(0.0)});
  const auto result = hmc(two_wells(), tabulated(verlet{}), listed(starts),
                          {.step = 0.02,
                           .length = 0.5,
                           .chains = 8,
                           .burn_in = 100,
                           .draws = 1,
                           .acceptance = 0.8,
                           .diagonal_masses = true},
                          ignored);
  BOOST_TEST_REQUIRE(result.deviations.size() == 1U);
  BOOST_TEST(std::abs(result.deviations[0] - 1.0) < 0.05);
}

// Beyond the first block of lanes, whose width depends on the machine.
BOOST_AUTO_TEST_CASE(a_refused_start_has_its_own_number) {
  std::vector<phase_point<double, 1>> starts(40, {number(1.0), number(0.0)});
  starts[37].q[0] = 0.0;
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] {
        hmc(wall(), tabulated(verlet{}), listed(starts),
            {.step = 0.1, .length = 1.0, .chains = 40, .burn_in = 0, .draws = 1}, ignored);
      },
      {"at start 37"}));
}
