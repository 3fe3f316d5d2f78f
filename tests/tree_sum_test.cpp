// SPDX-License-Identifier: BSL-1.0
#include "nysalt/tree_sum.hpp"

#include <boost/test/unit_test.hpp>

#include <atomic>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "nysalt/ensemble_loop.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(it_adds_every_term_once) {
  for (std::size_t n = 1; n < 200; ++n) {
    std::vector<double> terms(n);
    std::iota(terms.begin(), terms.end(), 1.0);
    BOOST_TEST(tree_sum(terms) == 0.5 * static_cast<double>(n * (n + 1)));  // integers: exact
  }
  BOOST_CHECK_THROW(tree_sum(std::vector<double>{}), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(the_order_is_leaves_of_16_then_a_tree) {
  std::vector<double> terms(3 * 16 + 5);
  for (std::size_t i = 0; i < terms.size(); ++i)
    terms[i] = std::sin(static_cast<double>(i)) * 1e3 + 1.0 / 3.0;
  const auto leaf = [&](std::size_t first, std::size_t last) {
    double sum = terms[first];
    for (std::size_t i = first + 1; i < last; ++i) sum += terms[i];
    return sum;
  };
  const double expected = (leaf(0, 16) + leaf(16, 32)) + (leaf(32, 48) + leaf(48, 53));
  BOOST_TEST(tree_sum(terms) == expected);
  // Another order gives other bits: the test above can tell.
  BOOST_TEST(std::accumulate(terms.begin(), terms.end(), 0.0) != expected);
}

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
