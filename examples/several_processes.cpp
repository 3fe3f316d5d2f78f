// SPDX-License-Identifier: BSL-1.0
// Learning with several processes, here or on a cluster: mpirun -n 4 example_several_processes
//
// Each process makes the trajectories that are its own and keeps them to itself. What all of them need are a
// few sums, which are added up in one order, independent of the ranks: any number of processes prints the
// same lines.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "nysalt/communicators/mpi.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

void learn_and_report(const communicator& ranks) {
  const fpu_chain<3> chain(50.0);
  const fpu_law<3> starts(chain);
  // [learn]
  const auto pairs = [&](std::uint64_t seed) {
    return make_flow_map_data(
        chain, starts, fine_steps(1e-3),
        {.step = 0.03, .trajectories = 400, .seed = seed, .execution = {.ranks = &ranks}});
  };
  const auto [theta, summary, method] =
      learn(nystrom{}, chain, pairs(1), pairs(2), {.loss = loss_named("state:1")});
  // [/learn]

  // How far the energy is off at t = 30, along trajectories that each process follows for itself.
  // [share]
  const ensemble_options options{
      .trajectories = 1000, .steps = 1000, .every = 1000, .seed = 3, .execution = {.ranks = &ranks}};
  const shard ours(options.trajectories, ranks);
  std::vector<double> squares(static_cast<std::size_t>(ours.count()));
  std::vector<double> at_start(squares.size());
  const auto take = [&](std::int64_t m, std::int64_t n, double current_energy) {
    const auto slot = static_cast<std::size_t>(m - ours.first());
    if (n == 0) at_start[slot] = current_energy;
    if (n > 0) squares[slot] = std::pow(current_energy - at_start[slot], 2);
  };
  const auto total_energy = over_lanes([&](const auto& x) { return energy_in_lanes(chain, x); });
  integrate_ensemble(chain, method, summary.step, starts, options, total_energy, take);
  const double error = std::sqrt(ours.sum(squares) / static_cast<double>(ours.total()));
  // [/share]

  if (!ranks.is_first()) return;  // one speaks for all
  fmt::print("learned from {} pairs of {} trajectories\n", summary.samples, summary.trajectories);
  fmt::print("b1 = {:.6f}, beta1 = {:.6f}\n", theta[0], theta[1]);
  fmt::print("energy off by {:.4f} after 1000 steps\n", error);
}

// [main]
int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  learn_and_report(mpi_communicator());
  MPI_Finalize();
}
// [/main]

// Expected output:
// learned from 6400 pairs of 400 trajectories
// b1 = 0.509507, beta1 = 0.401782
// energy off by 0.0149 after 1000 steps
