// SPDX-License-Identifier: BSL-1.0
// Every hard case in its short form, a test each; and that the page can be trusted with their names.
#include <boost/test/unit_test.hpp>

#include <set>

#include "../../../bench/studies/hard/hard_case.hpp"

using namespace nysalt::hard;

namespace {

/// A test of its own for each case, by its name: what the suites of Boost.Test register by hand.
struct register_cases {
  register_cases() {
    for (const auto& topic : all_topics()) {
      for (const auto& one : topic.cases) {
        const auto test = [one] {
          const verdict result = one.run(extent::quick);
          for (const auto& sentence : result.measured()) BOOST_TEST_MESSAGE(sentence);
          BOOST_TEST(
              result.holds(), one.must_hold << [&] {
                std::string all;
                for (const auto& sentence : result.measured()) all += "\n  " + sentence;
                return all;
              }());
        };
        boost::unit_test::framework::master_test_suite().add(
            boost::unit_test::make_test_case(test, one.name, __FILE__, __LINE__));
      }
    }
  }
};

const register_cases all_of_them;

}  // namespace

BOOST_AUTO_TEST_CASE(cases_have_names_of_their_own_and_say_what_must_hold_and_fail) {
  std::set<std::string> names;
  std::size_t cases = 0;
  for (const auto& topic : all_topics()) {
    for (const auto& one : topic.cases) {
      ++cases;
      names.insert(one.name);
      BOOST_TEST(!one.must_hold.empty(), one.name);
      BOOST_TEST(!one.must_fail.empty(), one.name);
    }
  }
  BOOST_TEST(names.size() == cases);
}

BOOST_AUTO_TEST_CASE(a_verdict_does_not_hold_if_anything_is_not_so) {
  verdict result;
  result.require(true, "fine");
  result.note("by the way");
  BOOST_TEST(result.holds());
  result.require(false, "wrong");
  result.require(true, "fine again");
  BOOST_TEST(!result.holds());
  BOOST_TEST(result.measured().size() == 4U);
}
