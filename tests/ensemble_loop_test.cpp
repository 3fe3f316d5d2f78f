// SPDX-License-Identifier: BSL-1.0
// Every trajectory once, by any number of lanes and threads; and the first exception.
#include "nysalt/detail/ensemble_loop.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(every_trajectory_is_visited_once_by_any_number_of_threads) {
  for (const int threads : {1, 2, 7}) {
    std::vector<int> visits(1000, 0);
    for_each_trajectory(1000, threads, [&](std::int64_t m) { ++visits[static_cast<std::size_t>(m)]; });
    for (const int count : visits) BOOST_TEST(count == 1);
  }
  for_each_trajectory(0, 2, [](std::int64_t) { BOOST_ERROR("there is none"); });
  BOOST_CHECK_THROW(for_each_trajectory(1, 0, [](std::int64_t) {}), std::invalid_argument);
}

// The later one is thrown long before the earlier one can be.
BOOST_AUTO_TEST_CASE(the_first_exception_leaves_the_loop) {
  for (const int threads : {1, 2, 5}) {
    std::atomic<bool> later = false;
    const auto body = [&](std::int64_t m) {
      if (m == 90) {
        later = true;
        throw std::runtime_error("90");
      }
      if (m != 17) return;
      const auto patience = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
      while (threads > 1 && !later && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
      throw std::runtime_error("17");
    };
    BOOST_TEST(refuses<std::runtime_error>([&] { for_each_trajectory(100, threads, body); }, {"17"}));
  }
}

BOOST_AUTO_TEST_CASE(blocks_cover_all_trajectories_once) {
  for (const std::int64_t count : {1, 7, 16, 100}) {
    for (const int width : {1, 3, 8, 16}) {
      std::vector<int> visits(static_cast<std::size_t>(count), 0);
      std::atomic<int> short_blocks = 0;
      std::atomic<int> off_blocks = 0;
      const auto visit = [&](std::int64_t first, int n) {
        if (first % width != 0) ++off_blocks;  // BOOST_TEST is for one thread
        if (n != width) ++short_blocks;
        for (int k = 0; k < n; ++k) ++visits[static_cast<std::size_t>(first + k)];
      };
      for_each_block(count, width, 2, visit);
      BOOST_TEST(off_blocks == 0);
      BOOST_TEST(std::count(visits.begin(), visits.end(), 1) == count);
      BOOST_TEST(short_blocks == (count % width == 0 ? 0 : 1));
    }
  }
  BOOST_CHECK_THROW(for_each_block(1, 0, 1, [](std::int64_t, int) {}), std::invalid_argument);
}

// In its block 21 is found in trouble before 18 is, as a later stage of the work finds it.
BOOST_AUTO_TEST_CASE(the_first_trajectory_in_trouble_is_named_by_any_number_of_lanes) {
  const auto body = [](std::int64_t first, int n) {
    for (const std::int64_t culprit : {21, 18, 70}) {
      if (first <= culprit && culprit < first + n) throw std::runtime_error(std::to_string(culprit));
    }
  };
  for (const int width : {1, 5, 8, 16, 100}) {
    for (const int threads : {1, 3}) {
      BOOST_TEST(refuses<std::runtime_error>([&] { for_each_block(100, width, threads, body); }, {"18"}));
    }
  }
}
