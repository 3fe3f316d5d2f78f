// SPDX-License-Identifier: BSL-1.0
// A Lennard-Jones liquid near its triple point against LAMMPS, on one core, and on two threads against one.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "agree.hpp"
#include "chain_run.hpp"
#include "lammps.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "peers/roofs.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

constexpr double density = 0.8442;
constexpr double temperature = 1.44;  // of the crystal, 0.72 or so of the liquid
constexpr double time_step = 0.005;
constexpr std::int64_t steps = 20;  // of a turn, in which lists are made twice

/// What LAMMPS does by default too.
lennard_jones_liquid liquid_of(Eigen::Index atoms, int threads = 1) {
  return lennard_jones_liquid(atoms, density, {.cutoff = 2.5, .smoothness = 0, .skin = 0.3})
      .on_threads(threads);
}

/// Our liquid under way.
struct ours {
  explicit ours(const lennard_jones_liquid& system) : liquid(system) {}
  void take_steps(std::int64_t count) { make_stepper(liquid, verlet{}, time_step).advance(run, count); }
  Eigen::VectorXd momenta() { return make_stepper(liquid, verlet{}, time_step).synchronous(run).p; }

  lennard_jones_liquid liquid;
  open_run<double, Eigen::Dynamic> run =
      make_stepper(liquid, verlet{}, time_step).open(lennard_jones_liquid_law(liquid, temperature)(1, 0));
};

/// Made and melted at the first turn, as that takes seconds.
struct pair_of_liquids {
  explicit pair_of_liquids(Eigen::Index atoms) : system(liquid_of(atoms)) {}

  ours& mine() {
    if (own) return *own;
    own = std::make_unique<ours>(system);
    own->take_steps(20);
    if (lammps_liquid::is_there()) {
      const auto start = lennard_jones_liquid_law(system, temperature)(1, 0);
      peer = std::make_unique<lammps_liquid>(system.side(), 2.5, 0.3, time_step, start);
      peer->take_steps(20);
      const Eigen::VectorXd found = own->momenta();
      const Eigen::VectorXd expected = peer->momenta();
      // Rounding, 1e-15 of a position, grows by less than 1e5 in so short a time.
      require_agreement("LAMMPS", numbers(found), numbers(expected), 1e-10);
      peer->take_steps(40);
    }
    own->take_steps(40);
    return *own;
  }
  lammps_liquid& theirs() {
    mine();
    return *peer;
  }

  lennard_jones_liquid system;
  std::unique_ptr<ours> own{};
  std::unique_ptr<lammps_liquid> peer{};
};

void race_with_lammps() {
  std::vector<runner> runners;
  for (const Eigen::Index atoms : {4000, 32000}) {
    const auto both = std::make_shared<pair_of_liquids>(atoms);
    const double work = static_cast<double>(atoms * steps);
    runners.push_back(
        {fmt::format("ours, {} atoms", atoms), work, [both] { both->mine().take_steps(steps); }});
    if (!lammps_liquid::is_there()) continue;
    runners.push_back(
        {fmt::format("LAMMPS, {} atoms", atoms), work, [both] { both->theirs().take_steps(steps); }});
  }
  race("liquid", std::move(runners), {.turn_seconds = 1e-3});
}

/// On one thread and on two, with a look at the bits first.
struct liquids_on_threads {
  ours& on(int threads) {
    if (!one) {
      constexpr Eigen::Index atoms = 32000;
      one = std::make_unique<ours>(liquid_of(atoms, 1));
      two = std::make_unique<ours>(liquid_of(atoms, 2));
      one->take_steps(60);
      two->take_steps(60);
      const Eigen::VectorXd expected = one->momenta();
      const Eigen::VectorXd found = two->momenta();
      require_agreement("the liquid on two threads", numbers(expected), numbers(found), 0.0);
    }
    return threads == 1 ? *one : *two;
  }
  std::unique_ptr<ours> one{};
  std::unique_ptr<ours> two{};
};

void race_threads_of_liquid() {
  const auto liquids = std::make_shared<liquids_on_threads>();
  constexpr double work = 32000.0 * steps;
  constexpr std::int64_t count = 10'000'000;
  const auto kernel = [](std::int64_t n) { benchmark::DoNotOptimize(mix_kernel<contraction::off>(n)); };
  std::vector<runner> runners;
  runners.push_back({"one thread", work, [=] { liquids->on(1).take_steps(steps); }});
  runners.push_back({"two threads", work, [=] { liquids->on(2).take_steps(steps); }});
  runners.push_back({"kernel, one thread", static_cast<double>(count), [=] { kernel(count); }});
  runners.push_back({"kernel, two threads", static_cast<double>(count), [=] {
                       std::jthread other([=] { kernel(count / 2); });
                       kernel(count / 2);
                     }});
  race("liquid on threads", std::move(runners), {.turn_seconds = 1e-3, .clock = clock_kind::wall});
}

}  // namespace

void race_liquid() {
  race_with_lammps();
  race_threads_of_liquid();
}

}  // namespace nysalt::bench
