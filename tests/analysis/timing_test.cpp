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
  const auto fastest = interleaved_seconds({[&] { order += 'a'; }, [&] { order += 'b'; }}, 3);
  BOOST_TEST(order == "abababab");
  BOOST_TEST(fastest.size() == 2);
  for (const double seconds : fastest) BOOST_TEST(seconds >= 0.0);
}

BOOST_AUTO_TEST_CASE(a_longer_job_takes_longer) {
  using namespace std::chrono_literals;
  int calls = 0;
  const auto fastest = interleaved_seconds({[] {}, [] { std::this_thread::sleep_for(2ms); },
                                            [&] {  // the first round is not counted, however slow
                                              if (calls++ == 0) std::this_thread::sleep_for(100ms);
                                            }},
                                           1);
  BOOST_TEST(fastest[1] >= 0.002);
  BOOST_TEST(fastest[0] < fastest[1]);
  BOOST_TEST(fastest[2] < 0.1);
}

BOOST_AUTO_TEST_CASE(an_interruption_does_not_count) {
  using namespace std::chrono_literals;
  int calls = 0;
  const auto fastest = interleaved_seconds({[&] {
                                             if (calls++ != 2) std::this_thread::sleep_for(50ms);
                                           }},
                                           3);
  BOOST_TEST(fastest[0] < 0.05);
}

BOOST_AUTO_TEST_CASE(no_jobs_and_no_rounds) {
  BOOST_TEST(interleaved_seconds({}, 3).empty());
  BOOST_TEST(std::isinf(interleaved_seconds({[] {}}, 0)[0]));
}
