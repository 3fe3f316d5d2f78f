// SPDX-License-Identifier: BSL-1.0
// An ensemble that ranks share: one number a trajectory, and its mean. Beside it a kernel that shares nothing
// and never leaves the registers, which tells what the machine has to give.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../peers/splitmix.hpp"
#include "measure.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "sizes.hpp"

namespace nysalt::bench {

namespace {

constexpr double omega = 50.0;
constexpr double h = 0.01;
const fpu_chain<3> chain(omega);
const in_bath<fpu_chain<3>> bathed(chain, bath::of_sigma(0.01, 0.05));

template <class Stepper>
double mean_stiff_energy(const Stepper& stepper, const size_of_work& size) {
  using system_type = typename Stepper::system_type;
  using T = detail::scalar_of_lanes<detail::lanes_of<system_type>>;
  const fpu_law<3> law(chain);
  const shard ours(size.trajectories, size.who->ranks());
  std::vector<double> terms(static_cast<std::size_t>(ours.count()));
  const auto read = [](const auto& x, std::span<T> number) {
    number[0] = value_in_lanes<T>([](const auto& y) { return chain.stiff_energy(y); }, x);
  };
  const auto take = [&](std::int64_t m, std::int64_t, std::span<const double> number) {
    terms[static_cast<std::size_t>(m - ours.first())] = number[0];
  };
  if (ours.count() > 0) {
    const ensemble_options options{.trajectories = ours.count(),
                                   .steps = size.steps,
                                   .every = size.steps,
                                   .execution = {.threads = size.threads},
                                   .first = ours.first()};
    integrate_ensemble<T>(stepper, law, options, 1, read, take);
  }
  return ours.sum(terms) / static_cast<double>(size.trajectories);
}

/// What ranks and threads find must not depend on them: else something else was timed.
class agreement {
 public:
  void require(const size_of_work& size, double mean) {
    const auto [known, is_new] = found_.emplace(std::pair(size.trajectories, size.steps), mean);
    if (is_new || known->second == mean) return;
    throw std::runtime_error("the mean of an ensemble depends on who computed it");
  }

 private:
  std::map<std::pair<std::int64_t, std::int64_t>, double> found_;
};

template <class Stepper>
void race(const std::string& what, const Stepper& stepper, const std::deque<first_ranks>& all,
          std::int64_t steps, int rounds) {
  constexpr std::int64_t trajectories = 4096;
  auto sizes = strong_and_weak(all, trajectories, steps);
  for (const std::int64_t fewer : {trajectories / 16, trajectories / 4, trajectories}) {
    for (const std::int64_t shorter : {steps / 100, steps / 10}) {
      sizes.push_back({"size", &all.front(), 1, fewer, shorter});
    }
  }
  agreement seen;
  std::vector<runner> runners;
  for (const auto& size : sizes) {
    runners.push_back({row_of(what, size), size.who,
                       [&stepper, &seen, size] { seen.require(size, mean_stiff_energy(stepper, size)); }});
  }
  take_turns(runners, rounds);
}

std::uint64_t mixed(std::int64_t count) {
  splitmix next;
  std::uint64_t result = 0;
  for (std::int64_t i = 0; i < count; ++i) result ^= next();
  return result;
}

void race_kernel(const std::deque<first_ranks>& all, int rounds) {
  constexpr std::int64_t numbers = 40'000'000;
  std::vector<runner> runners;
  for (const auto& size : strong_and_weak(all, 4096, numbers / 4096)) {
    if (size.threads > 1) continue;
    const std::int64_t share = size.trajectories * size.steps / size.who->size();
    runners.push_back({row_of("kernel", size), size.who, [share, who = size.who] {
                         const std::uint64_t last = mixed(share);
                         who->ranks().sum(static_cast<std::int64_t>(last % 2));
                       }});
  }
  take_turns(runners, rounds);
}

}  // namespace

void measure_stepping() {
  const auto all = numbers_of_ranks();
  constexpr int rounds = 21;
  race_kernel(all, rounds);
  race("two-stage", make_stepper(chain, mclachlan2{}, h), all, 8000, rounds);
  race("BAOAB", make_stepper(bathed, baoab{}, h, counter_noise(1)), all, 2000, rounds);
}

}  // namespace nysalt::bench
