// SPDX-License-Identifier: BSL-1.0
// What a stepper refuses in a bath, and what noise it draws.
#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include <set>
#include <tuple>

#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/pendulum.hpp"
#include "support/noises.hpp"
#include "support/refusal.hpp"
#include "support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;

const in_bath warm(pendulum(), bath::of_sigma(0.3, 0.2));
const in_bath heated(pendulum(), bath::of_sigma(0.0, 0.2));
const in_bath cold(pendulum(), bath::of_temperature(0.3, 0.0));
const in_bath trivial(pendulum(), bath::of_temperature(0.0, 0.7));

phase_point<double, 1> somewhere() { return {vector<double, 1>(0.7), vector<double, 1>(-0.4)}; }

bool made(const auto&... arguments) {
  return !refuses<wrong>([&] { make_stepper(arguments...); }, {});
}
bool refused(const auto& system, const auto& method, double step, const auto& noise,
             std::initializer_list<std::string_view> words) {
  return refuses<wrong>([&] { make_stepper(system, method, step, noise); }, words);
}

/// What 100 steps draw, looked at every so often and at the end.
template <bool DrawsFreely = true>
drawn_noise drawn_by(const auto& system, const auto& method, std::int64_t every) {
  drawn_noise notes;
  const auto fixed = make_stepper(system, method, 0.1, noted_noise<DrawsFreely>(notes));
  auto run = fixed.open(somewhere(), 3);
  fixed.advance(run, 100, every, [](auto&&...) {});
  return notes;
}

using place = std::tuple<std::uint64_t, std::int64_t, int>;
std::set<place> different(const std::vector<noise_place>& places) {
  std::set<place> result;
  for (const auto& [trajectory, step, flow] : places) result.insert({trajectory, step, flow});
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_noisy_bath_needs_a_source_of_noise) {
  for (const auto& system : {warm, heated}) {
    const auto description = system.bath().description();
    BOOST_TEST(refused(system, baoab(), 0.1, no_noise(),
                       {description, "must have a source of noise", "counter_noise(seed)"}));
    BOOST_TEST(
        refused(system, tabulated(obabo{}), 0.1, no_noise(), {description, "must have a source of noise"}));
    BOOST_TEST(made(system, baoab(), 0.1, counter_noise(1)));
  }
  for (const auto& system : {cold, trivial}) {
    BOOST_TEST(made(system, baoab(), 0.1));
    BOOST_TEST(made(system, tabulated(obabo{}), 0.1));
    BOOST_TEST(made(system, baoab(), 0.1, counter_noise(1)));
  }
}

BOOST_AUTO_TEST_CASE(a_bath_that_acts_needs_a_letter_of_the_word) {
  for (const auto& system : {warm, heated, cold}) {
    const auto description = system.bath().description();
    BOOST_TEST(refused(system, verlet(), 0.1, counter_noise(1),
                       {description, "BAB", "must have a letter O", "thermostat"}));
    BOOST_TEST(refused(system, tabulated(verlet{}), 0.1, counter_noise(1),
                       {description, "BAB", "must have a letter O"}));
    BOOST_TEST(refused(system, verlet(), 0.1, no_noise(), {"must have a letter O"}));
  }
  BOOST_TEST(made(trivial, verlet(), 0.1));
  BOOST_TEST(made(trivial, tabulated(verlet{}), 0.1));
  BOOST_TEST(made(warm.base(), baoab(), 0.1));  // the system without its bath
}

BOOST_AUTO_TEST_CASE(noise_does_not_go_back_in_time_but_damping_does) {
  for (const auto& system : {warm, heated}) {
    BOOST_TEST(refused(system, baoab(), -0.1, counter_noise(1), {"letter O", "back in time", "-0.1"}));
    BOOST_TEST(refused(system, tabulated(obabo{}), -0.1, counter_noise(1), {"back in time"}));
  }
  BOOST_TEST(made(trivial, baoab(), -0.1));
  // A palindrome's step back undoes its step; some ten operations on numbers of size one, twice.
  const auto undone = [](const auto& method) {
    auto x = somewhere();
    make_stepper(cold, method, 0.1).step(x);
    BOOST_TEST(distance(x, somewhere()) > 0.01);
    make_stepper(cold, method, -0.1).step(x);
    return distance(x, somewhere()) <= 20.0 * eps;
  };
  BOOST_TEST(undone(baoab()));
  BOOST_TEST(undone(obabo()));
  BOOST_TEST(undone(tabulated(aboba{})));
}

BOOST_AUTO_TEST_CASE(a_step_is_finite_and_not_zero_in_a_bath_too) {
  for (const double step :
       {0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    BOOST_TEST(refused(warm, baoab(), step, counter_noise(1), {"step", "finite and not zero"}));
    BOOST_TEST(refused(warm, tabulated(obabo{}), step, counter_noise(1), {"finite and not zero"}));
  }
}

BOOST_AUTO_TEST_CASE(each_letter_has_a_coefficient_whatever_the_bath) {
  const run_time_word letters("OBABO");
  const auto with = [&](const auto& system, std::size_t count) {
    using S = std::remove_cvref_t<decltype(system)>;
    return refuses<wrong>(
        [&] {
          stepper<S, run_time_word, double, counter_noise>(system, letters, std::vector<double>(count, 0.5),
                                                           0.1, counter_noise(1));
        },
        {"OBABO", "5 letters", fmt::format("{} coefficients", count)});
  };
  for (const std::size_t count : {0U, 3U, 4U, 6U}) {
    BOOST_TEST(with(warm, count));
    BOOST_TEST(with(trivial, count));
    BOOST_TEST(with(warm.base(), count));
  }
}

// A letter O draws its numbers once a step; halves that meet draw one for both, and the other when looked at.
BOOST_AUTO_TEST_CASE(noise_is_drawn_once) {
  for (const std::int64_t every : {1, 1000}) {
    BOOST_TEST(drawn_by(warm, baoab(), every).normals.size() == 100U);
    BOOST_TEST(drawn_by(warm, baoab(), every).halves.empty());
    BOOST_TEST(drawn_by(warm, baoab_2x(), every).normals.size() == 200U);
    BOOST_TEST(drawn_by<false>(warm, baoab(), every).normals.size() == 100U);
  }
  const auto unseen = drawn_by(warm, obabo(), 1000);
  BOOST_TEST(unseen.normals.size() == 100U);
  BOOST_TEST(unseen.halves.size() == 1U);  // of which the first step has only one
  const auto seen = drawn_by(warm, obabo(), 10);
  BOOST_TEST(seen.normals.size() == 100U + 10U);
  BOOST_TEST(seen.halves.size() == 1U + 10U);
  BOOST_TEST(drawn_by<false>(warm, obabo(), 1000).normals.size() == 199U);  // the last half is still to come
}

BOOST_AUTO_TEST_CASE(each_letter_of_each_step_has_numbers_of_its_own) {
  const auto check = [](const auto& method, std::size_t places, std::int64_t last_step, int last_letter) {
    const auto found = different(drawn_by(warm, method, 1000).normals);
    BOOST_TEST(found.size() == places);
    BOOST_TEST((*found.begin() == place{3, 0, 0}));
    BOOST_TEST((*found.rbegin() == place{3, last_step, last_letter}));
  };
  check(baoab(), 100, 99, 0);
  check(baoab_2x(), 200, 99, 1);
  check(obabo(), 100, 99, 0);
  check(tabulated(baoab_2x{}), 200, 99, 1);
  check(tabulated("mine", run_time_word("OAOBO"), {0.25, 1.0, 0.5, 1.0, 0.25}, {1, false, false}), 200, 99,
        1);
  const auto path = different(drawn_by<false>(warm, obabo(), 1).normals);
  BOOST_TEST(path.size() == 200U);
  BOOST_TEST((*path.rbegin() == place{3, 99, 1}));
}

BOOST_AUTO_TEST_CASE(a_cold_or_trivial_bath_draws_nothing) {
  for (const auto& system : {cold, trivial}) {
    for (const std::int64_t every : {1, 1000}) {
      const auto check = [&](const auto& method) {
        const auto drawn = drawn_by(system, method, every);
        BOOST_TEST(drawn.normals.empty());
        BOOST_TEST(drawn.halves.empty());
      };
      check(baoab());
      check(obabo());
      check(tabulated(obabo{}));
      check(tabulated(baoab_2x{}));
    }
  }
}

BOOST_AUTO_TEST_CASE(looking_at_a_run_draws_for_the_look_alone) {
  drawn_noise notes;
  const auto fixed = make_stepper(warm, obabo(), 0.1, noted_noise<true>(notes));
  auto run = fixed.open(somewhere());
  BOOST_TEST((same_bits(fixed.synchronous(run), somewhere())));  // at the start there is no noise
  BOOST_TEST(notes.normals.empty());
  fixed.advance(run, 5);
  notes = {};
  const auto once = fixed.synchronous(run);
  BOOST_TEST(notes.halves.size() == 1U);
  BOOST_TEST(notes.halves.front().step == 5);
  BOOST_TEST((same_bits(fixed.synchronous(run), once)));
}
