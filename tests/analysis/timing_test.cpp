// SPDX-License-Identifier: BSL-1.0
#include <boost/test/unit_test.hpp>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "nysalt/analysis/timing.hpp"

using namespace nysalt;

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
