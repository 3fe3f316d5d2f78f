// SPDX-License-Identifier: BSL-1.0
// The ranks of mpirun: messages arrive whole, and sums have the bits of one process. Run on three ranks.
#include "nysalt/communicators/mpi.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/shard.hpp"

using namespace nysalt;

namespace {

struct mpi {
  mpi() { MPI_Init(nullptr, nullptr); }
  ~mpi() { MPI_Finalize(); }
};
BOOST_TEST_GLOBAL_FIXTURE(mpi);

std::span<std::byte> bytes_of(auto& values) { return std::as_writable_bytes(std::span(values)); }

}  // namespace

BOOST_AUTO_TEST_CASE(there_are_three_ranks) {
  const mpi_communicator ranks;
  BOOST_TEST(ranks.size() == 3);
  BOOST_TEST(ranks.sum(ranks.rank()) == 3);
  BOOST_TEST(ranks.minimum(10 - ranks.rank()) == 8);
}

BOOST_AUTO_TEST_CASE(messages_arrive_in_order_and_do_not_mix_with_those_of_others) {
  const mpi_communicator ranks;
  const mpi_communicator others;
  std::vector<double> large(100'000);  // beyond what MPI sends without waiting
  if (ranks.rank() == 1) {
    std::iota(large.begin(), large.end(), 0.0);
    int first = 7;
    int second = 8;
    others.send(std::as_bytes(std::span(&first, 1)), 0);
    ranks.send(std::as_bytes(std::span(&second, 1)), 0);
    ranks.send(bytes_of(large), 0);
  }
  if (ranks.rank() == 0) {
    int second = 0;
    int first = 0;
    ranks.receive(std::as_writable_bytes(std::span(&second, 1)), 1);
    ranks.receive(bytes_of(large), 1);
    others.receive(std::as_writable_bytes(std::span(&first, 1)), 1);
    BOOST_TEST(first == 7);
    BOOST_TEST(second == 8);
    BOOST_TEST(large.back() == 99'999.0);
  }
}

BOOST_AUTO_TEST_CASE(long_messages_go_in_pieces) {
  const mpi_communicator ranks(MPI_COMM_WORLD, 1000);  // bytes
  std::vector<int> numbers(12'345);
  if (ranks.rank() == 2) std::iota(numbers.begin(), numbers.end(), 0);
  ranks.broadcast(bytes_of(numbers), 2);
  BOOST_TEST(numbers.back() == 12'344);
  if (ranks.rank() == 1) ranks.send(bytes_of(numbers), 0);
  std::vector<int> again(numbers.size());
  if (ranks.rank() == 0) ranks.receive(bytes_of(again), 1);
  BOOST_TEST((ranks.rank() != 0 || again == numbers));
  const std::vector<int> ours(500, ranks.rank());
  const auto all = all_gather(ranks, ours);
  BOOST_TEST(std::accumulate(all.begin(), all.end(), 0) == 500 * 3);
  BOOST_TEST(all[1000] == 2);
}

BOOST_AUTO_TEST_CASE(all_get_what_one_tells_and_what_each_has) {
  const mpi_communicator ranks;
  std::string text = ranks.rank() == 2 ? "from the last" : "";
  broadcast(ranks, text, 2);
  BOOST_TEST(text == "from the last");
  const std::vector<int> ours(static_cast<std::size_t>(ranks.rank()), ranks.rank());  // none, one, two
  BOOST_TEST((all_gather(ranks, ours) == std::vector<int>{1, 2, 2}));
  BOOST_TEST((all_gather(ranks, 10 * ranks.rank()) == std::vector<int>{0, 10, 20}));
}

BOOST_AUTO_TEST_CASE(a_sum_has_the_bits_of_one_process) {
  const mpi_communicator ranks;
  for (const std::int64_t total : {5, 1000, 20'011}) {
    std::vector<double> terms;
    for (std::int64_t m = 0; m < total; ++m)
      terms.push_back(std::sin(static_cast<double>(m)) * 1e3 + 1.0 / 3);
    const shard share(total, ranks);
    const auto first = terms.begin() + static_cast<std::ptrdiff_t>(share.first());
    BOOST_TEST(share.sum({first, first + static_cast<std::ptrdiff_t>(share.count())}) == tree_sum(terms));
  }
}

BOOST_AUTO_TEST_CASE(what_fails_on_one_fails_on_all) {
  const mpi_communicator ranks;
  const auto fails = [&] {
    if (ranks.rank() == 1) throw std::invalid_argument("the second");
  };
  BOOST_CHECK_EXCEPTION(collectively(ranks, fails), std::invalid_argument,
                        [](const auto& problem) { return problem.what() == std::string("the second"); });
}
