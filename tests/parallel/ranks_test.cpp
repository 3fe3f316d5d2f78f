// SPDX-License-Identifier: BSL-1.0
// Ranks that share trajectories: which rank has which, sums with the bits of one rank, and what fails on one
// rank fails on all, in the same words.
#include <atomic>

#include "../support/ranks_as_threads.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/model.hpp"
#include "nysalt/shard.hpp"
#include "nysalt/systems/textbook.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Numbers whose sum depends on the order.
std::vector<double> some_terms(std::int64_t count) {
  std::vector<double> terms;
  for (std::int64_t m = 0; m < count; ++m) {
    terms.push_back(std::sin(static_cast<double>(m)) * std::pow(10.0, static_cast<double>(m % 7)) +
                    1.0 / 3.0);
  }
  return terms;
}

template <class T>
std::vector<T> part_of(const std::vector<T>& all, const shard& ours) {
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(ours.first());
  return {first, first + static_cast<std::ptrdiff_t>(ours.count())};
}

/// The most that passes at one rank in a sum of `size` doubles over that many trajectories.
traffic most_of_a_sum(int ranks, std::int64_t trajectories, Eigen::Index size) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
  traffic most;
  std::mutex guard;
  run_ranks(ranks, [&](const thread_communicator& ours) {
    const shard share(trajectories, ours);
    const std::vector<Eigen::VectorXd> terms(static_cast<std::size_t>(share.count()), zero);
    share.sum(terms, zero);
    const std::lock_guard lock(guard);
    most.sent = std::max(most.sent, ours.seen().sent);
    most.received = std::max(most.received, ours.seen().received);
    most.together = std::max(most.together, ours.seen().together);
    most.bytes = std::max(most.bytes, ours.seen().bytes);
  });
  return most;
}

/// What each of five ranks catches of work that throws on some.
template <class Thrown>
std::vector<std::string> caught_by_all(const std::vector<int>& bad, const auto&... words) {
  std::vector<std::string> caught(5);
  run_ranks(5, [&](const thread_communicator& ours) {
    try {
      collectively(ours, [&] {
        if (std::ranges::find(bad, ours.rank()) != bad.end())
          throw Thrown((words + std::to_string(ours.rank()))...);
      });
    } catch (const Thrown& problem) {
      caught[static_cast<std::size_t>(ours.rank())] = problem.what();
    }
  });
  return caught;
}

struct own_kind : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_sum_is_of_leaves_of_16_and_then_a_tree) {
  for (std::size_t n = 1; n < 200; ++n) {
    std::vector<double> terms(n);
    std::iota(terms.begin(), terms.end(), 1.0);
    BOOST_TEST(tree_sum(terms) == 0.5 * static_cast<double>(n * (n + 1)));  // integers: exact
  }
  BOOST_CHECK_THROW(tree_sum(std::vector<double>{}), std::invalid_argument);
  const auto terms = some_terms(3 * 16 + 5);
  const auto sum = [&](int first, int last) {
    return std::accumulate(terms.begin() + first + 1, terms.begin() + last,
                           terms[static_cast<std::size_t>(first)]);
  };
  BOOST_TEST(tree_sum(terms) == (sum(0, 16) + sum(16, 32)) + (sum(32, 48) + sum(48, 53)));
  BOOST_TEST(tree_sum(terms) != sum(0, 53));  // another order has other bits
}

BOOST_AUTO_TEST_CASE(each_trajectory_is_with_one_rank_and_leaves_are_whole) {
  for (const std::int64_t total : {1, 15, 16, 17, 100, 1000, 4096, 100'003}) {
    for (const int ranks : {1, 2, 3, 5, 64}) {
      std::int64_t next = 0;
      std::int64_t largest = 0;
      for (int r = 0; r < ranks; ++r) {
        const thread_communicator ours = rank_alone(r, ranks);
        const shard share(total, ours);
        BOOST_TEST(share.first() == next);
        BOOST_TEST((share.count() == 0 || share.first() % detail::trajectories_of_leaf == 0));
        next = share.first() + share.count();
        largest = std::max(largest, share.count());
      }
      BOOST_TEST(next == total);
      // One part in 32 beside an equal share, or one leaf, whatever is more.
      const double equal = static_cast<double>(total) / ranks;
      BOOST_TEST(static_cast<double>(largest) <= std::max(equal * 33.0 / 32.0, equal + 16.0));
    }
  }
}

BOOST_AUTO_TEST_CASE(further_trajectories_stay_with_their_ranks) {
  constexpr std::int64_t total = 1000;
  constexpr std::int64_t leaf = 48;
  for (const std::int64_t known : {0, 17, 500, 1000}) {
    std::int64_t next = 0;
    for (int r = 0; r < 3; ++r) {
      const thread_communicator ours = rank_alone(r, 3);
      const shard share(total, ours, leaf);
      BOOST_TEST(share.first() % leaf == 0);
      const shard further = share.beyond(known);
      BOOST_TEST(further.total() == total - known);
      BOOST_TEST(further.first() == next);
      BOOST_TEST(further.first() == std::max<std::int64_t>(share.first() - known, 0));
      next += further.count();
    }
    BOOST_TEST(next == total - known);
  }
}

// Each trajectory is visited once, in a block of its rank; and what a block throws is thrown on all ranks.
BOOST_AUTO_TEST_CASE(the_driver_visits_the_trajectories_of_each_rank) {
  constexpr std::int64_t total = 100;
  const model system{harmonic_oscillator(1.0)};
  std::vector<std::atomic<int>> visits(total);
  std::atomic<int> caught = 0;
  run_ranks(3, [&](const thread_communicator& ours) {
    const shard share(total, ours);
    detail::for_each_lane_block(
        system, share, 8, {.threads = 2}, [&](const model& own, std::int64_t first, int count) {
          if (own.size() != 1 || first < share.first() || first + count > share.first() + share.count())
            return;
          for (int k = 0; k < count; ++k) ++visits[static_cast<std::size_t>(first + k)];
        });
    try {
      detail::for_each_lane_block(system, share, 8, {.threads = 2},
                                  [](const model&, std::int64_t first, int count) {
                                    if (first <= 70 && 70 < first + count)
                                      throw std::invalid_argument("number 70");
                                  });
    } catch (const std::invalid_argument&) {
      ++caught;
    }
  });
  BOOST_TEST(std::ranges::all_of(visits, [](const auto& of_each) { return of_each == 1; }));
  BOOST_TEST(caught == 3);
}

BOOST_AUTO_TEST_CASE(a_sum_of_ranks_has_the_bits_of_one) {
  int other = 0;
  for (const std::int64_t total : {1, 16, 17, 250, 1000, 2000, 3001, 5000, 20'011}) {
    const auto terms = some_terms(total);
    const double expected = tree_sum(terms);
    BOOST_TEST(shard(total).sum(terms) == expected);
    for (const int ranks : {2, 3, 5, 13}) {
      std::vector<double> found(static_cast<std::size_t>(ranks));
      run_ranks(ranks, [&](const thread_communicator& ours) {
        const shard share(total, ours);
        found[static_cast<std::size_t>(ours.rank())] = share.sum(part_of(terms, share));
      });
      BOOST_TEST(std::ranges::count(found, expected) == ranks);
    }
    double naive = 0.0;  // the sum of the ranks' sums
    for (int r = 0; r < 3; ++r) {
      const thread_communicator ours = rank_alone(r, 3);
      const auto part = part_of(terms, shard(total, ours));
      if (!part.empty()) naive += tree_sum(part);
    }
    other += naive != expected;
  }
  BOOST_TEST(other > 0);
}

BOOST_AUTO_TEST_CASE(what_ranks_gather_is_everywhere) {
  std::int64_t bytes = 0;
  for (const std::int64_t total : {1, 100, 1000, 2000}) {
    const std::int64_t before = bytes;
    run_ranks(3, [&](const thread_communicator& ours) {
      const shard share(total, ours);
      std::vector<std::int64_t> all(static_cast<std::size_t>(total), -1);
      for (std::int64_t m = share.first(); m < share.first() + share.count(); ++m) {
        all[static_cast<std::size_t>(m)] = m * m;
      }
      share.gather(all);
      for (std::int64_t m = 0; m < total; ++m) {
        if (all[static_cast<std::size_t>(m)] != m * m) throw std::logic_error("not gathered");
      }
      std::vector<int> twice((static_cast<std::size_t>(total) + 7) / 8 * 2, -1);  // two for each eight
      for (std::int64_t m = share.first(); m < share.first() + share.count(); ++m) {
        for (const std::int64_t i : {0, 1}) twice[static_cast<std::size_t>(m / 8 * 2 + i)] = ours.rank();
      }
      share.gather(twice, 2, 8);
      if (!std::ranges::is_sorted(twice) || twice.front() != 0)
        throw std::logic_error("not gathered in groups");
      if (ours.is_first()) bytes = ours.seen().bytes;
    });
    if (total == 2000) BOOST_TEST(bytes == 2 * before);  // it grows with the data, and the traffic shows it
  }
}

BOOST_AUTO_TEST_CASE(terms_that_are_not_those_of_the_rank_are_refused) {
  const shard whole(100);
  BOOST_CHECK_THROW(whole.sum(std::vector<double>(99)), std::invalid_argument);
  const thread_communicator second = rank_alone(1, 2);
  const shard half(100, second);
  BOOST_CHECK_THROW(half.sum(std::vector<double>(100)), std::invalid_argument);
  std::vector<int> some(static_cast<std::size_t>(half.count()));
  BOOST_CHECK_THROW(half.gather(some), std::invalid_argument);
}

// Of P parameters a pass over the data passes on 1 + P + P (P + 1)/2 numbers: here those of P = 2.
BOOST_AUTO_TEST_CASE(messages_grow_with_the_logarithm_of_the_ranks_and_not_with_the_data) {
  constexpr Eigen::Index size = 6;
  for (const int ranks : {2, 4, 8, 32}) {
    const int log2 = static_cast<int>(std::bit_width(static_cast<unsigned>(ranks))) - 1;
    // From some 32 leaves a rank on, the tree above the blocks is the same whatever the data.
    for (const int times : {1, 4}) {
      const auto seen = most_of_a_sum(ranks, 16 * 64 * ranks * times, size);
      BOOST_TEST(seen.received == log2);  // powers of two: whole subtrees
      BOOST_TEST(seen.sent == 1);
      BOOST_TEST(seen.together == 1);
      BOOST_TEST(seen.bytes == 8 * size * (log2 + 1));
    }
  }
  for (const int ranks : {3, 5, 27}) {
    const int log2 = static_cast<int>(std::bit_width(static_cast<unsigned>(ranks)));
    const auto seen = most_of_a_sum(ranks, 16 * 500 * ranks + 5, size);
    // A share of 32 to 64 blocks is up 7 levels at most before its last node leaves it.
    BOOST_TEST(seen.received <= log2 + 7);
    BOOST_TEST(seen.sent <= 7);
    BOOST_TEST(seen.together == 1);
  }
}

BOOST_AUTO_TEST_CASE(the_lowest_rank_that_throws_is_heard_on_all) {
  const std::string trouble = "trouble on ";
  const std::vector<std::string> expected(5, "trouble on 2");
  BOOST_TEST((caught_by_all<std::invalid_argument>({4, 2}, trouble) == expected));
  BOOST_TEST((caught_by_all<std::runtime_error>({2}, trouble) == expected));
  BOOST_TEST((caught_by_all<std::bad_alloc>({3}) == std::vector<std::string>(5, std::bad_alloc().what())));
  BOOST_TEST((caught_by_all<std::runtime_error>({}, trouble) == std::vector<std::string>(5)));
}

BOOST_AUTO_TEST_CASE(all_ranks_see_an_exception_of_one_type) {
  std::vector<std::string> said(3);
  run_ranks(3, [&](const thread_communicator& ours) {
    try {
      collectively(ours, [&] {
        if (ours.rank() == 1) throw own_kind("mine");
      });
    } catch (const own_kind&) {  // not even where it was thrown
    } catch (const std::runtime_error& problem) {
      said[static_cast<std::size_t>(ours.rank())] = problem.what();
    }
  });
  BOOST_TEST((said == std::vector<std::string>(3, "mine")));
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
