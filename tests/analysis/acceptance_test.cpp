// SPDX-License-Identifier: BSL-1.0
// The acceptance of Hybrid Monte Carlo, against a closed form and against one trajectory after the other.
#include "nysalt/analysis/acceptance.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>

#include "../support/in_lanes.hpp"
#include "../support/ranks_as_threads.hpp"
#include "../support/refusal.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/gibbs_of_modes.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/free_composition.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const fpu_chain<3> chain(50.0);
const fpu_law<3> law(chain);

/// On the oscillator n steps are a linear map of determinant 1. In (omega q, p)/sqrt(kT) it has singular
/// values s and 1/s, and a start of the Gibbs law is two standard normals (u, v) along its axes:
/// (H' - H)/kT = ((s^2 - 1) u^2 - (1 - s^-2) v^2)/2 falls where |u/v| < 1/s, with the probability
/// (2/pi) arctan(1/s). A reversible map that keeps volume accepts twice as often as it loses energy.
template <Method M>
double expected(const harmonic_oscillator& system, double omega, const M& method, double step,
                std::int64_t steps) {
  const auto image = [&](double x, double p) {
    phase_point<double, 1> at{vector<double, 1>(x / omega), vector<double, 1>(p)};
    const auto end = integrate(system, method, step, at, steps).finish;
    return std::array{end.q[0] * omega, end.p[0]};
  };
  const auto [a, c] = image(1.0, 0.0);
  const auto [b, d] = image(0.0, 1.0);
  const double sum = a * a + b * b + c * c + d * d;  // s^2 + 1/s^2
  const double s = std::sqrt((sum + std::sqrt(sum * sum - 4.0)) / 2.0);
  return 4.0 / std::numbers::pi * std::atan(1.0 / s);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_oscillator_is_known) {
  constexpr double omega = 2.0;
  const harmonic_oscillator system(omega);
  const auto check = [&](const auto& method, double z, double temperature) {
    const trajectory_options options{
        .step = z / omega, .steps = 5, .trajectories = 20'000, .seed = seed(1), .threads = 2};
    const gibbs_of_modes<1> starts(system, temperature);
    const auto found = acceptance(system, method, starts, options, temperature).probability;
    const double known = expected(system, omega, method, z / omega, options.steps);
    BOOST_TEST(known < 0.97);
    const double allowed = standard_errors(false_alarms / 3);
    BOOST_TEST(std::abs(found.mean - known) < allowed * found.standard_error);
    BOOST_TEST(found.standard_error < 0.5 / std::sqrt(20'000.0));  // of numbers within [0, 1]
    const auto colder = acceptance(system, method, starts, options, 0.5 * temperature).probability;
    BOOST_TEST(known - colder.mean > allowed * colder.standard_error);
  };
  check(verlet(), 1.0, 1.0);
  check(verlet(), 1.5, 0.3);
  check(bcss2(), 3.0, 2.0);
}

BOOST_AUTO_TEST_CASE(it_is_the_mean_over_trajectories_of_what_integrate_says) {
  const trajectory_options options{.step = 0.03, .steps = 70, .trajectories = 37, .seed = 3};
  const auto all = acceptance(chain, verlet(), law, options, 0.1);
  BOOST_REQUIRE(all.of_each.size() == 37U);
  double sum = 0.0;
  for (std::uint64_t m = 0; m < 37; ++m) {
    const auto start = law(options.seed, m);
    const auto end = integrate(chain, verlet(), options.step, start, options.steps).finish;
    const double rise = energy<double>(chain, end) - energy<double>(chain, start);
    const double expected = std::min(1.0, std::exp(-rise / 0.1));
    BOOST_TEST(all.of_each[m] == expected);
    sum += expected;
  }
  BOOST_TEST(all.probability.mean == sum / 37.0, boost::test_tools::tolerance(1e-14));  // 37 roundings
  BOOST_TEST(all.probability.mean > 0.1);
  BOOST_TEST(all.probability.mean < 0.99);
  BOOST_TEST(all.evaluations_per_time == 71.0 / (70 * 0.03), boost::test_tools::tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(lanes_and_threads_change_no_bit) {
  trajectory_options options{.step = 0.03, .steps = 10, .trajectories = 37};
  const auto in_lanes_of_it = acceptance(chain, bcss2(), law, options).of_each;
  options.threads = 3;
  BOOST_TEST(acceptance(chain, bcss2(), law, options).of_each == in_lanes_of_it);
  BOOST_TEST(acceptance(in_lanes<fpu_chain<3>, 1>(chain), bcss2(), law, options).of_each == in_lanes_of_it);
  options.seed = 2;
  BOOST_TEST(acceptance(chain, bcss2(), law, options).of_each != in_lanes_of_it);
}

// Of 37 trajectories there are three leaves, and of five ranks two have nothing to follow; some diverge.
BOOST_AUTO_TEST_CASE(ranks_change_no_bit) {
  trajectory_options options{.step = 0.05, .steps = 3, .trajectories = 37};
  const auto expected = acceptance(chain, bcss2(), law, options);
  for (const int size : {1, 2, 3, 5}) {
    std::vector<acceptance_result> found(static_cast<std::size_t>(size));
    run_ranks(size, [&](const communicator& ranks) {
      trajectory_options on_ranks = options;
      on_ranks.ranks = &ranks;
      found[static_cast<std::size_t>(ranks.rank())] = acceptance(chain, bcss2(), law, on_ranks);
    });
    for (const auto& result : found) {
      BOOST_TEST(result.of_each == expected.of_each);
      BOOST_TEST(result.probability.mean == expected.probability.mean);
      BOOST_TEST(result.diverged_at.size() == expected.diverged_at.size());
    }
  }
}

BOOST_AUTO_TEST_CASE(what_diverged_is_rejected) {
  const trajectory_options options{.step = 0.05, .steps = 3, .trajectories = 40};
  const auto all = acceptance(chain, verlet(), law, options);
  BOOST_TEST(all.diverged_at.size() > 0U);
  BOOST_TEST(all.diverged_at.size() < 40U);
  for (const auto& [m, step] : all.diverged_at) {
    BOOST_TEST(all.of_each[static_cast<std::size_t>(m)] == 0.0);
    const auto start = law(options.seed, static_cast<std::uint64_t>(m));
    BOOST_TEST(integrate(chain, verlet(), 0.05, start, 3).diverged_at.value() == step);
  }
  BOOST_TEST(!std::isnan(all.probability.mean));  // a mean of errors would leave them out
}

namespace {

/// K = sqrt(1 + p^2) + tilt p + bend p^3, odd where it must not be, with a velocity or without.
struct tilted {
  static constexpr int dimension = 2;
  double tilt = 0.0;
  double bend = 0.0;
  template <class T>
  T potential(const vector<T, 2>& q) const {
    return (q[0] * q[0] + q[1] * q[1]) * 0.5;
  }
  template <class T>
  T kinetic_energy(const vector<T, 2>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + p[1] * p[1] + 1.0) + p[1] * tilt + p[1] * p[1] * p[1] * bend;
  }
};
struct tilted_with_velocity : tilted {
  template <class T>
  void velocity(const vector<T, 2>& p, vector<T, 2>& v) const {
    using std::sqrt;
    const T energy = sqrt(p[0] * p[0] + p[1] * p[1] + 1.0);
    v[0] = p[0] / energy;
    v[1] = p[1] / energy + p[1] * p[1] * (3.0 * bend) + tilt;
  }
};

template <class S>
void check_even_alone() {
  const trajectory_options options{.step = 0.1, .steps = 5, .trajectories = 20};
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 1.0, 1.0);
  const auto with = [&](double tilt, double bend) {
    S system;
    system.tilt = tilt;
    system.bend = bend;
    return acceptance(system, verlet(), starts, options).of_each.size();
  };
  BOOST_TEST(with(0.0, 0.0) == 20U);
  for (const auto& odd : {std::pair(1e-3, 0.0), std::pair(0.0, 1e-3), std::pair(-1.0, 0.3)}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { with(odd.first, odd.second); },
                                              {"kinetic energy", "even", "initial state 0"}));
  }
}

}  // namespace

// With an odd K a palindrome runs back from (q, p) by -h, and not from (q, -p).
BOOST_AUTO_TEST_CASE(a_kinetic_energy_that_is_not_even_is_refused) {
  check_even_alone<tilted>();
  check_even_alone<tilted_with_velocity>();
}

BOOST_AUTO_TEST_CASE(what_is_no_proposal_is_refused) {
  using refusal = std::invalid_argument;
  const trajectory_options options{.step = 0.01, .steps = 5, .trajectories = 3};
  const member<aba3_free> one_way(aba3_free::start());
  BOOST_TEST(refuses<refusal>([&] { acceptance(chain, one_way, law, options); },
                              {"aba3_free", "must be reversible", "symmetric"}));
  const in_bath<fpu_chain<3>> warm(chain, bath::of_temperature(1.0, 1.0));
  BOOST_TEST(refuses<refusal>([&] { acceptance(warm, verlet(), law, options); }, {"bath"}));
  const in_bath<fpu_chain<3>> at_rest(chain, bath::of_sigma(0.0, 0.0));
  BOOST_TEST(acceptance(at_rest, verlet(), law, options).of_each.size() == 3U);
  for (const double temperature : {0.0, -1.0, double(INFINITY), double(NAN)}) {
    BOOST_TEST(refuses<refusal>([&] { acceptance(chain, verlet(), law, options, temperature); },
                                {"kT", "positive"}));
  }
  BOOST_TEST(refuses<refusal>([&] { acceptance(chain, verlet(), law, {.step = 0.01, .steps = 0}); },
                              {"0 steps", "at least 1"}));
}
