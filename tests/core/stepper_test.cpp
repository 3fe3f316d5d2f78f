// SPDX-License-Identifier: BSL-1.0
// What a stepper does, what it refuses, in a bath too, and what noise it draws.
#include <set>
#include "../support/noises.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/core.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using said = std::initializer_list<std::string_view>;
using point = phase_point<double, 1>;
using state = phase_point<double, Eigen::Dynamic>;

const model swing = pendulum();
const model warm = in_bath(pendulum(), bath::of_sigma(0.3, 0.2));
const model heated = in_bath(pendulum(), bath::of_sigma(0.0, 0.2));
const model cold = in_bath(pendulum(), bath::of_temperature(0.3, 0.0));
const model trivial = in_bath(pendulum(), bath::of_temperature(0.0, 0.7));
const tabulated by_verlet{verlet()};
const tabulated by_baoab{baoab()};
const tabulated by_obabo{obabo()};
const tabulated by_two{baoab_2x()};

point near_rest() { return {vector<double, 1>(0.7), vector<double, 1>(-0.4)}; }
state somewhere() { return {near_rest().q, near_rest().p}; }

template <class Noise = counter_noise>
bool refused(const model& system, const tabulated& method, double step, said words,
             const Noise& noise = Noise(1)) {
  return refuses<wrong>([&] { make_stepper(system, method, step, noise); }, words);
}
bool refused_without_noise(const model& system, const tabulated& method, said words) {
  return refuses<wrong>([&] { make_stepper(system, method, 0.1); }, words);
}

/// What 100 steps draw, looked at every so often and at the end.
template <bool DrawsFreely = true>
drawn_noise drawn_by(const model& system, const tabulated& method, std::int64_t every) {
  drawn_noise notes;
  const auto fixed = make_stepper(system, method, 0.1, noted_noise<DrawsFreely>(notes));
  auto run = fixed.open(somewhere(), 3);
  fixed.advance(run, 100, every, [](auto&&...) {});
  return notes;
}

using place = std::tuple<std::uint64_t, std::int64_t, int>;
std::set<place> different(const std::vector<noise_place>& places) {
  std::set<place> all;
  for (const auto& [trajectory, step, flow] : places) all.insert({trajectory, step, flow});
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_run_from_q_and_p_is_an_open_run_to_the_bit) {
  for (const auto& method : {by_baoab, by_obabo}) {
    const auto fixed = make_stepper(warm, method, 0.1, counter_noise(1));
    const auto run_of = [&](std::uint64_t trajectory, int steps) {
      auto run = fixed.open(somewhere(), trajectory);
      fixed.advance(run, steps);
      return fixed.synchronous(run);
    };
    flow_state<double, Eigen::Dynamic> x{somewhere(), Eigen::VectorXd::Zero(1)};
    auto y = x;
    constexpr std::array after{2, 5};
    std::vector<state> seen;
    fixed.run(x, y, after, 3, [&](std::size_t k) {
      BOOST_TEST(k == seen.size());
      seen.push_back(y);
    });
    BOOST_TEST_REQUIRE(seen.size() == 2U);
    BOOST_TEST(same_bits(seen[0], run_of(3, 2)));
    BOOST_TEST(same_bits(seen[1], run_of(3, 5)));
    BOOST_TEST(!same_bits(seen[1], run_of(2, 5)));
    BOOST_TEST(!same_bits(seen[1], run_of(3, 4)));
  }
}

BOOST_AUTO_TEST_CASE(a_step_is_finite_and_not_zero) {
  for (const double step :
       {0.0, -0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    BOOST_TEST(refused(swing, by_verlet, step, {"step", "finite and not zero"}, no_noise()));
    BOOST_TEST(refused(warm, by_obabo, step, {"step", "finite and not zero"}));
    const pendulum system;
    BOOST_TEST(refuses<wrong>([&] { make_stepper(system, verlet(), step); }, {"finite and not zero"}));
  }
  BOOST_TEST(make_stepper(swing, by_verlet, -0.1).step_size() == -0.1);
}

BOOST_AUTO_TEST_CASE(a_bath_that_acts_needs_a_letter_of_the_word_and_noise_a_source) {
  for (const model* system : {&warm, &heated, &cold}) {
    const auto description = system->bath().description();
    BOOST_TEST(refused(*system, by_verlet, 0.1, {description, "BAB", "must have a letter O", "thermostat"}));
    BOOST_TEST(refused_without_noise(*system, by_verlet, {"must have a letter O"}));
    for (const auto& method : {by_baoab, by_obabo}) {
      BOOST_TEST(!refused(*system, method, 0.1, {}));
      const bool is_noisy = system != &cold;
      const said why{is_noisy ? description.c_str() : "", "must have a source of noise",
                     "counter_noise(seed)"};
      BOOST_TEST(refused_without_noise(*system, method, why) == is_noisy);
    }
  }
  for (const auto& method : {by_baoab, by_obabo, by_verlet}) {
    BOOST_TEST(!refused(trivial, method, 0.1, {}));
    BOOST_TEST(!refused_without_noise(trivial, method, {}));
  }
  BOOST_TEST(!refused_without_noise(warm.base(), by_baoab, {}));  // the system without its bath
}

BOOST_AUTO_TEST_CASE(noise_does_not_go_back_in_time_but_damping_does) {
  for (const model* system : {&warm, &heated}) {
    BOOST_TEST(refused(*system, by_baoab, -0.1, {"letter O", "back in time", "-0.1"}));
  }
  BOOST_TEST(!refused(trivial, by_baoab, -0.1, {}));
  // A palindrome's step back undoes its step; some ten operations on numbers of size one, twice.
  for (const auto& method : {by_baoab, by_obabo, tabulated(aboba())}) {
    auto x = somewhere();
    make_stepper(cold, method, 0.1).step(x);
    BOOST_TEST(distance(x, somewhere()) > 0.01);
    make_stepper(cold, method, -0.1).step(x);
    BOOST_TEST(distance(x, somewhere()) <= 20.0 * eps);
  }
}

BOOST_AUTO_TEST_CASE(each_letter_has_a_coefficient_whatever_the_bath) {
  for (const std::size_t count : {0U, 3U, 4U, 6U}) {
    const std::string got = fmt::format("{} coefficients", count);
    for (const model& system : {warm, trivial, warm.base()}) {
      const auto make = [&] {
        stepper<model, run_time_word, double, counter_noise>(
            system, run_time_word("OBABO"), std::vector<double>(count, 0.5), 0.1, counter_noise(1));
      };
      BOOST_TEST(refuses<wrong>(make, {"OBABO", "5 letters", got}));
    }
  }
}

// A letter O draws its numbers once a step; halves that meet draw one for both, and the other when looked at.
// Each letter of each step has numbers of its own.
BOOST_AUTO_TEST_CASE(noise_is_drawn_once) {
  const auto places_of = [](const drawn_noise& drawn, int last_letter) {
    const auto places = different(drawn.normals);
    BOOST_TEST((*places.begin() == place{3, 0, 0}));
    BOOST_TEST((*places.rbegin() == place{3, 99, last_letter}));
    return places.size();
  };
  const auto drew = [](const drawn_noise& drawn, std::size_t normals, std::size_t halves) {
    return drawn.normals.size() == normals && drawn.halves.size() == halves;
  };
  const tabulated mine("mine", run_time_word("OAOBO"), {0.25, 1.0, 0.5, 1.0, 0.25}, {1, false, false});
  for (const std::int64_t every : {1, 1000}) {
    BOOST_TEST(drew(drawn_by(warm, by_baoab, every), 100, 0));
    BOOST_TEST(drew(drawn_by<false>(warm, by_baoab, every), 100, 0));
    BOOST_TEST(places_of(drawn_by(warm, by_baoab, every), 0) == 100U);
    BOOST_TEST(drew(drawn_by(warm, by_two, every), 200, 0));
    BOOST_TEST(places_of(drawn_by(warm, by_two, every), 1) == 200U);
    for (const model* system : {&cold, &trivial}) {
      for (const auto& method : {by_baoab, by_obabo, by_two})
        BOOST_TEST(drew(drawn_by(*system, method, every), 0, 0));
    }
  }
  // Of the halves the first step has only one; of a path the last half is still to come.
  BOOST_TEST(drew(drawn_by(warm, by_obabo, 1000), 100, 1));
  BOOST_TEST(drew(drawn_by(warm, by_obabo, 10), 100 + 10, 1 + 10));
  BOOST_TEST(drawn_by<false>(warm, by_obabo, 1000).normals.size() == 199U);
  BOOST_TEST(places_of(drawn_by(warm, by_obabo, 1000), 0) == 100U);
  BOOST_TEST(places_of(drawn_by<false>(warm, by_obabo, 1), 1) == 200U);
  BOOST_TEST(places_of(drawn_by(warm, mine, 1000), 1) == 200U);
}

BOOST_AUTO_TEST_CASE(looking_at_a_run_draws_for_the_look_alone) {
  drawn_noise notes;
  const auto fixed = make_stepper(warm, by_obabo, 0.1, noted_noise<true>(notes));
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
