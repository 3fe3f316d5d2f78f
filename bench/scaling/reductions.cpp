// SPDX-License-Identifier: BSL-1.0
// One sum over all ranks: a leaf of terms each, so that messages are all that it takes.
#include <Eigen/Core>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "measure.hpp"
#include "nysalt/shard.hpp"
#include "sizes.hpp"

namespace nysalt::bench {

namespace {

void measure(const first_ranks& all, Eigen::Index numbers, int sums) {
  const shard ours(detail::trajectories_of_leaf * all.size(), all.ranks());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(numbers);
  const std::vector<Eigen::VectorXd> terms(static_cast<std::size_t>(ours.count()),
                                           Eigen::VectorXd::Ones(numbers));
  std::vector<double> seconds;
  for (int n = 0; n < sums; ++n) {
    // Where the last has ended, the next begins: rank 0 waits for what is on its way, as in a search.
    using clock = std::chrono::steady_clock;
    const auto began = clock::now();
    ours.sum(terms, zero);
    seconds.push_back(std::chrono::duration<double>(clock::now() - began).count());
  }
  std::sort(seconds.begin(), seconds.end());
  print_row({{"what", "reduction"},
             {"ranks", all.size()},
             {"cores", std::thread::hardware_concurrency()},
             {"doubles", numbers},
             {"sums", sums},
             {"seconds", seconds[seconds.size() / 2]},
             {"seconds_90", seconds[seconds.size() * 9 / 10]}});
}

}  // namespace

void measure_reductions() {
  const first_ranks all(size_of_job());
  const bool has_cores = size_of_job() <= static_cast<int>(std::thread::hardware_concurrency());
  for (int round = 0; round < 5; ++round) {
    for (const Eigen::Index numbers : {6, 66}) {  // of 2 and of 10 parameters
      all.ranks().sum(0);
      measure(all, numbers, has_cores ? 5000 : 50);
    }
  }
}

}  // namespace nysalt::bench
