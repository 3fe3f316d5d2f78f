// SPDX-License-Identifier: BSL-1.0
// What pilots find, and what they do not let pass.
#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "../support/systems.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/pendulum.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using failure = std::runtime_error;
using vector_1 = vector<double, 1>;
using vector_2 = vector<double, 2>;
const normal_around<1> around_0({vector_1(0.0), vector_1(0.0)}, 1.0, 1.0);
const normal_around<1> far_off({vector_1(20.0), vector_1(0.0)}, 1.0, 1.0);
const normal_around<2> near_0({vector_2::Zero(), vector_2::Zero()}, 0.1, 0.1);
const harmonic_oscillator oscillator(3.0);

/// V = q^4/4: <V> = kT/4 for every temperature. A linear force would leave BAOAB no bias in q.
struct quartic {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * q[0] * q[0] * 0.25;
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * q[0] * q[0] * -1.0;
  }
};

template <class S>
in_bath<S> at(double temperature, const S& system) {
  return {system, bath::of_temperature(0.01, temperature)};
}

}  // namespace

// With friction 2 omega, x" = -2 omega x' - omega^2 x + noise: rho_q(t) = (1 + omega t) e^{-omega t}, and
// rho of q^2 is its square: tau = 2 int (1 + s)^2 e^{-2 s} ds/omega = 2.5/omega. For p, (1 - s) in place of
// (1 + s): 0.5/omega. A pilot knows tau to sqrt(2/1024) = 4.4 %, and its finite time adds 1/32.
BOOST_AUTO_TEST_CASE(tau_of_a_damped_oscillator_is_that_of_theory) {
  const gibbs ensemble(at(0.7, oscillator), around_0, {.friction = 6.0, .pilots = 1024, .seed = seed(1)});
  BOOST_TEST(std::abs(ensemble.report().tau * 3.0 / 2.5 - 1.0) <=
             standard_errors(false_alarms) * 0.044 + 1.0 / 32.0);
  BOOST_TEST(ensemble.report().length >= 20.0 * ensemble.report().tau);
}

BOOST_AUTO_TEST_CASE(the_friction_is_one_that_forgets) {
  const gibbs ensemble(at(0.7, oscillator), around_0);
  const gibbs slow(at(0.7, oscillator), around_0, {.friction = 0.01 * 3.0});
  BOOST_TEST(ensemble.report().tau < 0.1 * slow.report().tau);
}

BOOST_AUTO_TEST_CASE(threads_change_no_bit) {
  const gibbs one(at(0.7, oscillator), around_0, {.friction = 6.0, .pilots = 50});
  const gibbs two(at(0.7, oscillator), around_0, {.friction = 6.0, .pilots = 50, .threads = 2});
  BOOST_TEST(one.report().tau == two.report().tau);
  BOOST_TEST(one.report().bias[1].mean == two.report().bias[1].mean);
  BOOST_TEST(one.report().excess[0].standard_error == two.report().excess[0].standard_error);
}

BOOST_AUTO_TEST_CASE(a_burn_in_that_is_too_short_is_refused) {
  for (const double length : {0.1, 1.0}) {
    BOOST_TEST(
        refuses<failure>([&] { gibbs(at(0.7, oscillator), far_off, {.friction = 6.0, .length = length}); },
                         {"gibbs", "after a burn-in of", "burn in for longer"}));
  }
  const gibbs enough(at(0.7, oscillator), far_off, {.friction = 6.0, .length = 10.0});
  BOOST_TEST(enough.report().length >= 10.0);
  BOOST_TEST(enough.report().length < 10.2);
}

// Most thermal frequency sqrt(3 q^2) is about 2: a step of 1 is too large, and 1/4 shows no bias.
BOOST_AUTO_TEST_CASE(a_step_with_a_bias_is_halved) {
  const gibbs coarse(at(1.0, quartic{}), around_0, {.friction = 1.0, .step = 1.0});
  const gibbs fine(at(1.0, quartic{}), around_0, {.friction = 1.0, .step = 0.125});
  BOOST_TEST(coarse.report().halvings >= 1);
  BOOST_TEST(coarse.report().step <= 0.5);
  BOOST_TEST(fine.report().halvings == 0);
  for (const auto* found : {&coarse.report(), &fine.report()}) {
    BOOST_TEST(!found->of(found->bias, watched::potential).shows());
    BOOST_TEST(!found->of(found->excess, watched::virial).shows());
  }
  double sum = 0.0;
  double squares = 0.0;
  constexpr int count = 1600;
  for (int n = 0; n < count; ++n) {
    const double v = quartic{}.potential(coarse(seed(3), static_cast<std::uint64_t>(n)).q);
    sum += v / count;
    squares += v * v / count;
  }
  BOOST_TEST(std::abs(sum - 0.25) <=
             standard_errors(false_alarms) * std::sqrt((squares - sum * sum) / count));
}

BOOST_AUTO_TEST_CASE(a_hopeless_step_is_refused) {
  BOOST_TEST(refuses<failure>([] { gibbs(at(1.0, oscillator), around_0, {.friction = 1.0, .step = 200.0}); },
                              {"gibbs", "pilot chain 0 that diverged", "step small enough"}));
}

BOOST_AUTO_TEST_CASE(where_the_motion_is_free_the_virial_does_not_count) {
  const gibbs turning(at(4.0, pendulum{}), around_0);
  const gibbs hanging(at(0.1, pendulum{}), around_0);
  BOOST_TEST(!turning.report().confined);
  BOOST_TEST(hanging.report().confined);
}

BOOST_AUTO_TEST_CASE(a_force_without_a_potential_will_do) {
  const gibbs ensemble(at(0.1, black_box{}), around_0, {.friction = 1.0, .step = 0.5, .pilots = 64});
  BOOST_TEST(ensemble.report().tau > 0.0);
  BOOST_TEST(ensemble.report().of(ensemble.report().bias, watched::potential).mean == 0.0);
}

BOOST_AUTO_TEST_CASE(what_is_not_confined_has_no_gibbs_law) {
  BOOST_TEST(
      refuses<failure>([] { gibbs(at(0.1, henon_heiles{}), near_0); },
                       {"gibbs", "pilot chain", "diverged at time", "must be confined", "henon_heiles()"}));
}

BOOST_AUTO_TEST_CASE(what_does_not_become_stationary_in_time_is_refused) {
  BOOST_TEST(
      refuses<failure>([] { gibbs(at(0.7, oscillator), around_0, {.friction = 1e-4, .most_steps = 4096}); },
                       {"gibbs", "must become stationary", "4096 steps"}));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto refused = [](const in_bath<harmonic_oscillator>& system, const burn_in_options& options,
                          std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { gibbs(system, around_0, options); }, words);
  };
  BOOST_TEST(refused({oscillator, bath::of_sigma(0.0, 0.1)}, {}, {"gibbs", "must have a temperature"}));
  BOOST_TEST(refused({oscillator, bath::of_sigma(0.0, 0.0)}, {}, {"gibbs", "must have a temperature"}));
  BOOST_TEST(
      refused({oscillator, bath::of_sigma(0.1, 0.0)}, {}, {"gibbs", "temperature must be > 0", "rests"}));
  const auto sound = at(1.0, oscillator);
  BOOST_TEST(refused(sound, {.friction = -1.0}, {"friction", "positive"}));
  BOOST_TEST(refused(sound, {.step = -1.0}, {"step", "positive"}));
  BOOST_TEST(refused(sound, {.length = std::nan("")}, {"length", "positive"}));
  BOOST_TEST(refused(sound, {.pilots = 3}, {"pilots must be 16 to", "got 3"}));
  BOOST_TEST(refused(sound, {.threads = 0}, {"thread"}));
  BOOST_TEST(refuses<wrong>([] { gibbs(at(1.0, quartic{}), around_0); }, {"gibbs", "frequency_bands()"}));
}
