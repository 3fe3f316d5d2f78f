// SPDX-License-Identifier: BSL-1.0
#include <boost/test/unit_test.hpp>

#include <string>
#include <thread>

#include "nysalt/analysis/timing.hpp"

using namespace nysalt;

BOOST_AUTO_TEST_CASE(jobs_take_turns_and_run_once_more_than_they_are_timed) {
  std::string order;
  const auto medians = interleaved_medians({[&] { order += 'a'; }, [&] { order += 'b'; }}, 3);
  BOOST_TEST(order == "abababab");
  BOOST_TEST(medians.size() == 2);
  for (const double seconds : medians) BOOST_TEST(seconds >= 0.0);
}

BOOST_AUTO_TEST_CASE(a_longer_job_takes_longer) {
  using namespace std::chrono_literals;
  int calls = 0;
  const auto medians = interleaved_medians({[] {}, [] { std::this_thread::sleep_for(2ms); },
                                            [&] {  // the first round is not counted, however slow
                                              if (calls++ == 0) std::this_thread::sleep_for(100ms);
                                            }},
                                           1);
  BOOST_TEST(medians[1] >= 0.002);
  BOOST_TEST(medians[0] < medians[1]);
  BOOST_TEST(medians[2] < 0.1);
}

BOOST_AUTO_TEST_CASE(no_jobs_and_no_rounds) {
  BOOST_TEST(interleaved_medians({}, 3).empty());
  BOOST_TEST(std::isnan(interleaved_medians({[] {}}, 0)[0]));
}
