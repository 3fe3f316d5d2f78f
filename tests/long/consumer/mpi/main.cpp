// SPDX-License-Identifier: BSL-1.0
// Which of 100 trajectories this process has: all of them where there is one.
#include <cstdio>

#include "nysalt/communicators/mpi.hpp"
#include "nysalt/shard.hpp"

int main(int argc, char** argv) {
  using namespace nysalt;
  MPI_Init(&argc, &argv);
  {
    const mpi_communicator ranks;
    const shard ours(100, ranks);
    std::printf("%d of %d has %lld from %lld\n", ranks.rank(), ranks.size(),
                static_cast<long long>(ours.count()), static_cast<long long>(ours.first()));
  }
  MPI_Finalize();
}

// Expected output:
// 0 of 1 has 100 from 0
