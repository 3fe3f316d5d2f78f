// SPDX-License-Identifier: BSL-1.0
// Progress where standard error is no terminal: lines in a log, and what a caller hears.
#include "../../src/comparison/progress.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <boost/test/unit_test.hpp>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "../support/scratch.hpp"

using namespace nysalt;
using namespace nysalt::program;
using namespace std::chrono_literals;

namespace {

/// What is said on standard error meanwhile.
std::string said_by(const auto& work) {
  const test::scratch folder("progress");
  const std::string file = (folder / "log").string();
  const int before = ::dup(STDERR_FILENO);
  const int log = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::dup2(log, STDERR_FILENO);
  work();
  ::dup2(before, STDERR_FILENO);
  ::close(log);
  ::close(before);
  return test::contents(file);
}

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_log_has_a_line_of_what_takes_long_and_none_of_the_rest) {
  const auto work = [](progress& shown) {
    shown.part("judging");
    std::this_thread::sleep_for(50ms);  // of many lines' time, or of none
    shown.part("running");
    shown.counter(4)(2);
    std::this_thread::sleep_for(50ms);
  };
  const std::string often = said_by([&] {
    progress shown(1ms);
    work(shown);
  });
  BOOST_TEST(has(often, "nysalt: judging ...\n"), often);
  BOOST_TEST(has(often, "nysalt: running: 50 %\n"), often);
  BOOST_TEST(!has(often, "\r"), often);
  BOOST_TEST(said_by([&] {
               progress shown;  // a line a minute
               work(shown);
             }) == "");
  progress shown(1ms);
  shown.part("judging");
  shown.clear();
  BOOST_TEST(said_by([] { std::this_thread::sleep_for(20ms); }) == "");  // nothing is under way
}

// Of 3 things after 2.1 s for the first, 4 s are left; nothing is said earlier.
BOOST_AUTO_TEST_CASE(the_time_left_is_that_of_the_things_to_come) {
  const std::string said = said_by([] {
    progress shown(1ms);
    shown.count(3, "families");
    shown.next();
    shown.part("learning a");
    std::this_thread::sleep_for(2100ms);
    shown.next();
    shown.part("learning b");
    std::this_thread::sleep_for(20ms);
  });
  BOOST_TEST(has(said, "nysalt: 2 of 3 families, 4 s left: learning b\n"), said);
  BOOST_TEST(!has(said, "1 of 3 families, "), said);
}

BOOST_AUTO_TEST_CASE(things_are_counted_until_the_count_ends) {
  const std::string said = said_by([] {
    progress shown(1ms);
    shown.count(2, "families");
    for (const char* what : {"learning a", "learning b"}) {
      shown.next();
      shown.part(what);
      std::this_thread::sleep_for(20ms);
    }
    shown.count(0, {});
    shown.part("judging");
    std::this_thread::sleep_for(20ms);
  });
  BOOST_TEST(has(said, "nysalt: 1 of 2 families: learning a\n"), said);
  BOOST_TEST(has(said, "nysalt: 2 of 2 families: learning b\n"), said);
  BOOST_TEST(has(said, "nysalt: judging ...\n"), said);
}

BOOST_AUTO_TEST_CASE(a_caller_hears_parts_and_shares_and_may_end_the_work) {
  std::vector<std::pair<std::string, double>> heard;
  const std::string said = said_by([&] {
    quiet_caller caller;
    caller.hears = [&](const std::string& what, double share) {
      heard.emplace_back(what, share);
      if (share > 0.6) throw std::runtime_error("enough");
    };
    const work_for here(caller);
    progress shown(1ms);
    shown.part("running");
    const auto count = shown.counter(10);
    count(1);
    count(5);
    count(5);  // no news
    BOOST_CHECK_THROW(count(7), std::runtime_error);
    std::this_thread::sleep_for(20ms);
  });
  BOOST_TEST(said == "");
  const std::vector<std::pair<std::string, double>> expected{
      {"running", 0.0}, {"running", 0.1}, {"running", 0.5}, {"running", 0.7}};
  BOOST_TEST((heard == expected));
  quiet_caller silent;
  const work_for here(silent);
  progress shown;
  shown.part("running");
  const auto count = shown.counter(10);
  BOOST_CHECK_NO_THROW(count(7));
  silent.wants_an_end = true;
  BOOST_CHECK_THROW(count(8), ended_early);
}
