// SPDX-License-Identifier: BSL-1.0
// Ranks that share trajectories: who has which, and sums with the bits of one rank.
#include "nysalt/shard.hpp"

#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "support/ranks_as_threads.hpp"

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

}  // namespace

BOOST_AUTO_TEST_CASE(each_trajectory_is_with_one_rank_and_leaves_are_whole) {
  for (const std::int64_t total : {1, 15, 16, 17, 100, 1000, 4096, 100'003}) {
    for (const int ranks : {1, 2, 3, 5, 64}) {
      std::int64_t next = 0;
      std::int64_t largest = 0;
      for (int r = 0; r < ranks; ++r) {
        const thread_communicator ours = rank_alone(r, ranks);
        const shard share(total, ours);
        BOOST_TEST(share.first() == next);
        BOOST_TEST((share.count() == 0 || share.first() % trajectories_of_leaf == 0));
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

BOOST_AUTO_TEST_CASE(a_sum_has_the_bits_of_one_rank) {
  for (const std::int64_t total : {1, 16, 17, 250, 1000, 5000, 20'011}) {
    const auto terms = some_terms(total);
    const double expected = tree_sum(terms);
    BOOST_TEST(shard(total).sum(terms) == expected);
    for (const int ranks : {2, 3, 5, 8, 13}) {
      std::mutex guard;
      run_ranks(ranks, [&](const thread_communicator& ours) {
        const shard share(total, ours);
        const double sum = share.sum(part_of(terms, share));
        const std::lock_guard lock(guard);
        BOOST_TEST(std::bit_cast<std::uint64_t>(sum) == std::bit_cast<std::uint64_t>(expected));
      });
    }
  }
}

BOOST_AUTO_TEST_CASE(sums_of_the_ranks_sums_have_other_bits) {
  int other = 0;
  for (const std::int64_t total : {1000, 2000, 3001, 5000}) {
    const auto terms = some_terms(total);
    double naive = 0.0;
    for (int r = 0; r < 3; ++r) {
      const thread_communicator ours = rank_alone(r, 3);
      naive += tree_sum(part_of(terms, shard(total, ours)));
    }
    if (naive != tree_sum(terms)) ++other;
  }
  BOOST_TEST(other > 0);
}

BOOST_AUTO_TEST_CASE(what_ranks_gather_is_everywhere) {
  for (const std::int64_t total : {1, 100, 1000}) {
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
    });
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
  for (const int ranks : {2, 4, 8, 16, 32}) {
    const int log2 = static_cast<int>(std::bit_width(static_cast<unsigned>(ranks))) - 1;
    // From some 32 leaves a rank on, the tree above the blocks is the same whatever the data.
    const auto few = most_of_a_sum(ranks, 16 * 64 * ranks, size);
    const auto many = most_of_a_sum(ranks, 16 * 64 * ranks * 8, size);
    BOOST_TEST(few.received == log2);  // powers of two: whole subtrees
    BOOST_TEST(few.sent == 1);
    BOOST_TEST(few.together == 1);
    BOOST_TEST(many.received == few.received);
    BOOST_TEST(many.sent == few.sent);
    BOOST_TEST(many.bytes == few.bytes);
    BOOST_TEST(many.bytes == 8 * size * (log2 + 1));
  }
  for (const int ranks : {3, 5, 11, 27}) {
    const int log2 = static_cast<int>(std::bit_width(static_cast<unsigned>(ranks)));
    const auto seen = most_of_a_sum(ranks, 16 * 1000 * ranks + 5, size);
    // A share of 32 to 64 blocks is up 7 levels at most before its last node leaves it.
    BOOST_TEST(seen.received <= log2 + 7);
    BOOST_TEST(seen.sent <= 7);
    BOOST_TEST(seen.together == 1);
  }
}

BOOST_AUTO_TEST_CASE(gathering_grows_with_the_data) {
  const auto bytes_of = [](std::int64_t total) {
    std::int64_t bytes = 0;
    run_ranks(2, [&](const thread_communicator& ours) {
      std::vector<double> all(static_cast<std::size_t>(total));
      shard(total, ours).gather(all);
      if (ours.is_first()) bytes = ours.seen().bytes;
    });
    return bytes;
  };
  BOOST_TEST(bytes_of(2000) == 2 * bytes_of(1000));  // so the count above can tell
}
