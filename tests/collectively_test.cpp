// SPDX-License-Identifier: BSL-1.0
// What fails on one rank fails on all, in the same words.
#include "nysalt/detail/collectively.hpp"

#include <boost/test/unit_test.hpp>

#include <mutex>
#include <string>
#include <vector>

#include "nysalt/communicators/one_rank.hpp"
#include "support/ranks_as_threads.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// What each of five ranks sees of work that throws on some.
template <class Thrown>
std::vector<std::string> words_of_all(const std::vector<int>& bad) {
  std::vector<std::string> words(5);
  run_ranks(5, [&](const thread_communicator& ours) {
    const auto r = static_cast<std::size_t>(ours.rank());
    const auto work = [&] {
      if (std::ranges::find(bad, ours.rank()) == bad.end()) return;
      if constexpr (std::is_same_v<Thrown, std::bad_alloc>)
        throw Thrown();
      else
        throw Thrown("trouble on " + std::to_string(ours.rank()));
    };
    try {
      collectively(ours, work);
    } catch (const Thrown& problem) {
      words[r] = problem.what();
    }
  });
  return words;
}

struct own_kind : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_lowest_rank_that_throws_is_heard_on_all) {
  const std::vector<std::string> expected(5, "trouble on 2");
  BOOST_TEST((words_of_all<std::invalid_argument>({4, 2}) == expected));
  BOOST_TEST((words_of_all<std::runtime_error>({2}) == expected));
  BOOST_TEST((words_of_all<std::bad_alloc>({3}) == std::vector<std::string>(5, std::bad_alloc().what())));
  BOOST_TEST((words_of_all<std::runtime_error>({}) == std::vector<std::string>(5)));
}

BOOST_AUTO_TEST_CASE(all_ranks_see_an_exception_of_one_type) {
  std::mutex guard;
  int of_own_kind = 0;
  int of_known_kind = 0;
  run_ranks(3, [&](const thread_communicator& ours) {
    try {
      collectively(ours, [&] {
        if (ours.rank() == 1) throw own_kind("mine");
      });
    } catch (const own_kind&) {  // not even where the exception was thrown
      const std::lock_guard lock(guard);
      ++of_own_kind;
    } catch (const std::runtime_error& problem) {
      const std::lock_guard lock(guard);
      if (problem.what() == std::string("mine")) ++of_known_kind;
    }
  });
  BOOST_TEST(of_own_kind == 0);
  BOOST_TEST(of_known_kind == 3);
  BOOST_CHECK_THROW(collectively(one_rank, [] { throw own_kind("mine"); }), own_kind);
}

BOOST_AUTO_TEST_CASE(the_first_rank_works_for_all) {
  std::vector<int> worked(4, 0);
  run_ranks(4, [&](const thread_communicator& ours) {
    on_first(ours, [&] { worked[static_cast<std::size_t>(ours.rank())] = 1; });
    std::string refused;
    try {
      on_first(ours, [] { throw std::runtime_error("the disk is full"); });
    } catch (const std::runtime_error& problem) {
      refused = problem.what();
    }
    if (refused != "the disk is full") throw std::logic_error("not told");
  });
  BOOST_TEST((worked == std::vector<int>{1, 0, 0, 0}));
}
