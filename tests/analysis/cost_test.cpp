// SPDX-License-Identifier: BSL-1.0
// What runs cost: force evaluations, which follow from the first two steps, and seconds of jobs that take
// turns.
#include <boost/test/unit_test.hpp>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "../support/refusal.hpp"
#include "nysalt/analysis/evaluations.hpp"
#include "nysalt/analysis/timing.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/counted.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using galaxy = in_bath<henon_heiles>;
const phase_point<double, 2> start{{0.1, 0.05}, {-0.05, 0.1}};
const galaxy warm(henon_heiles(), bath::of_sigma(0.5, 0.1));
const galaxy damped(henon_heiles(), bath::of_sigma(0.5, 0.0));
const galaxy at_rest(henon_heiles(), bath::of_sigma(0.0, 0.0));

std::int64_t counted_through(const auto& system, const auto& method, std::int64_t steps) {
  const counted watched(system);
  const auto stepper = make_stepper(watched, method, 0.1, counter_noise(0));
  auto run = stepper.open(start);
  stepper.advance(run, steps);
  stepper.synchronous(run);  // costs nothing
  return watched.evaluations;
}

void check(const auto& system, const auto& method, std::int64_t to_open, std::int64_t of_a_step) {
  for (const std::int64_t steps : {0, 1, 2, 3, 10}) {
    BOOST_TEST_CONTEXT(method.name() << " over " << steps << " steps of " << describe(system)) {
      const auto told = evaluations_of_run(system, method, 0.1, steps, start);
      BOOST_TEST(told == counted_through(system, method, steps));
      BOOST_TEST(told == to_open + steps * of_a_step);
      BOOST_TEST(evaluations_of_run(system, tabulated(method), 0.1, steps, start) == told);
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(letters_of_the_bath_cost_no_force) {
  for (const galaxy& system : {warm, damped, at_rest}) {
    check(system, baoab(), 1, 1);
    check(system, baoab_2x(), 1, 2);
    check(system, obabo(), 1, 1);
    check(system, thermostat<placement::end>(mclachlan2()), 0, 2);
    check(system, thermostat<placement::symmetric>(mclachlan2()), 0, 2);
    check(system, thermostat<placement::middle>(mclachlan2()), 0, 2);
    check(system, thermostat<placement::symmetric>(verlet()), 1, 1);
  }
}

// The two kicks of A B O B A are at one q, with a letter between them: the force is asked for once.
BOOST_AUTO_TEST_CASE(a_force_is_used_again_beyond_a_letter_of_the_bath) {
  for (const galaxy& system : {warm, damped, at_rest}) check(system, aboba(), 0, 1);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_stepped_is_not_counted) {
  const auto refused = [](const auto& system, const auto& method, double step, std::int64_t steps) {
    return refuses<std::invalid_argument>([&] { evaluations_of_run(system, method, step, steps, start); },
                                          {});
  };
  BOOST_TEST(!refused(warm, baoab(), 0.1, 5));
  BOOST_TEST(refused(warm, baoab(), 0.0, 5));
  BOOST_TEST(refused(warm, baoab(), 0.1, -5));
  BOOST_TEST(refused(warm, verlet(), 0.1, 5));  // no letter O
}

BOOST_AUTO_TEST_CASE(steps_are_not_taken_to_be_counted) {
  BOOST_TEST(evaluations_of_run(warm, baoab(), 0.1, 1'000'000'000'000, start) == 1'000'000'000'001);
}

BOOST_AUTO_TEST_CASE(jobs_take_turns_and_run_once_more_than_they_are_timed) {
  std::string order;
  const auto timed = interleaved_seconds({[&] { order += 'a'; }, [&] { order += 'b'; }}, 3);
  BOOST_TEST(order == "abababab");
  BOOST_TEST(timed.size() == 2);
  for (const timed_job& job : timed) {
    BOOST_TEST(job.rounds == 3);
    BOOST_TEST(job.least >= 0.0);
    BOOST_TEST(job.median >= job.least);
  }
}

BOOST_AUTO_TEST_CASE(a_longer_job_takes_longer) {
  using namespace std::chrono_literals;
  int calls = 0;
  const auto timed = interleaved_seconds({[] {}, [] { std::this_thread::sleep_for(2ms); },
                                          [&] {  // the first round is not counted, however slow
                                            if (calls++ == 0) std::this_thread::sleep_for(100ms);
                                          }},
                                         1);
  BOOST_TEST(timed[1].least >= 0.002);
  BOOST_TEST(timed[0].least < timed[1].least);
  BOOST_TEST(timed[2].median < 0.1);
}

// Two of three rounds are slow: the median is theirs.
BOOST_AUTO_TEST_CASE(an_interruption_does_not_count) {
  using namespace std::chrono_literals;
  int calls = 0;
  const auto timed = interleaved_seconds({[&] {
                                           if (calls++ != 2) std::this_thread::sleep_for(50ms);
                                         }},
                                         3);
  BOOST_TEST(timed[0].least < 0.05);
  BOOST_TEST(timed[0].median >= 0.05);
}

BOOST_AUTO_TEST_CASE(no_jobs_and_no_rounds) {
  BOOST_TEST(interleaved_seconds({}, 3).empty());
  const timed_job untimed = interleaved_seconds({[] {}}, 0).front();
  BOOST_TEST(untimed.rounds == 0);
  BOOST_TEST(std::isinf(untimed.least));
  BOOST_TEST(std::isnan(untimed.median));
}
