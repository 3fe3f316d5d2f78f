// SPDX-License-Identifier: BSL-1.0
// A step in a bath: ours in all lanes, against loops that take one normal number after the other; and what of
// it is noise.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "ensemble_run.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "peers/scalar_baoab.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

using bathed_chain = in_bath<fpu_chain<3>>;
using peer = void (*)(std::span<chain_state<double>>, const langevin_run&, std::int64_t);

constexpr double omega = 50.0;
constexpr double h = 0.01;
constexpr std::int64_t trajectories = 4 * pack<double>::lanes;
constexpr std::int64_t steps = 500;

void run_baoab(states& all, const bathed_chain& chain, std::int64_t of_steps) {
  run_ensemble(all, make_stepper(chain, baoab{}, h, counter_noise(1)), of_steps, 1);
}

void run_baoab(states& all, const bathed_chain& chain, std::int64_t of_steps, peer theirs) {
  const langevin_run run{0.5 * omega * omega, h, chain.bath().decay(h), chain.bath().deviation(h)};
  std::vector<chain_state<double>> plain(all.size());
  for (std::size_t m = 0; m < all.size(); ++m) {
    std::copy(all[m].q.begin(), all[m].q.end(), plain[m].q.begin());
    std::copy(all[m].p.begin(), all[m].p.end(), plain[m].p.begin());
  }
  theirs(plain, run, of_steps);
  for (std::size_t m = 0; m < all.size(); ++m) {
    std::copy(plain[m].q.begin(), plain[m].q.end(), all[m].q.begin());
    std::copy(plain[m].p.begin(), plain[m].p.end(), all[m].p.begin());
  }
}

struct estimate {
  double mean;
  double squared_error;
};

estimate mean_of(const states& all, const auto& observable) {
  const auto n = static_cast<double>(all.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const auto& x : all) {
    sum += observable(x);
    squares += observable(x) * observable(x);
  }
  return {sum / n, (squares / n - (sum / n) * (sum / n)) / n};
}

/// Noise differs, so they can agree in law alone: in kinetic and in stiff energy to 5 standard errors, ten
/// times 1/friction after a start far away, in a bath that is as warm and has a hundred times the friction.
void require_law(const std::string& name, peer theirs) {
  const bathed_chain chain(fpu_chain<3>(omega), bath::of_temperature(1.0, 0.125));
  constexpr std::int64_t of_steps = 1000;
  const auto require_equal = [&](const char* what, const estimate& a, const estimate& b) {
    if (std::abs(a.mean - b.mean) < 5.0 * std::sqrt(a.squared_error + b.squared_error)) return;
    throw std::runtime_error(
        fmt::format("{} ends with a mean {} energy of {}, ours with {}: another law, and it is not timed",
                    name, what, b.mean, a.mean));
  };
  states ours = starts_of(2048);  // costs a tenth
  states others = starts_of(512);
  run_baoab(ours, chain, of_steps);
  run_baoab(others, chain, of_steps, theirs);
  const auto kinetic = [](const auto& x) { return 0.5 * x.p.squaredNorm(); };
  const auto stiff = [&](const auto& x) { return chain.stiff_energy(x); };
  require_equal("kinetic", mean_of(ours, kinetic), mean_of(others, kinetic));
  require_equal("stiff", mean_of(ours, stiff), mean_of(others, stiff));
}

/// The numbers of a step, and nothing done with them.
void draw_noise() {
  const counter_noise noise(1);
  vector<pack<double>, 6> xi;
  for (std::int64_t m = 0; m < trajectories; m += pack<double>::lanes) {
    for (std::int64_t n = 0; n < steps; ++n) {
      noise.normals({static_cast<std::uint64_t>(m), n, 0}, xi);
      benchmark::DoNotOptimize(xi.data());
      benchmark::ClobberMemory();
    }
  }
}

}  // namespace

void race_langevin() {
  static const bathed_chain chain(fpu_chain<3>(omega), bath::of_sigma(0.01, 0.05));
  const auto starts = std::make_shared<states>(starts_of(trajectories));
  std::vector<runner> runners;
  const auto add = [&](const std::string& name, auto run) {
    runners.push_back({name, static_cast<double>(trajectories * steps), [starts, run] {
                         states x = *starts;
                         run(x);
                         benchmark::DoNotOptimize(x.data());
                         benchmark::ClobberMemory();
                       }});
  };
  const auto add_stepper = [&](const std::string& name, const auto& stepper) {
    add(name, [stepper](states& x) { run_ensemble(x, stepper, steps, 1); });
  };
  const auto add_peer = [&](const std::string& name, peer theirs) {
    require_law(name, theirs);
    add(name, [theirs](states& x) { run_baoab(x, chain, steps, theirs); });
  };
  add_stepper("ours", make_stepper(chain, baoab{}, h, counter_noise(1)));
  static const model by_library = chain;
  add_stepper("ours, by the library", make_stepper(by_library, baoab{}, h, counter_noise(1)));
  add_peer("Boost's ziggurat", baoab_ziggurat<contraction::off>);
  add_peer("Boost's ziggurat, splitmix64", baoab_ziggurat_splitmix<contraction::off>);
  add_peer("std::normal_distribution", baoab_std<contraction::off>);
  add_peer("std::normal_distribution, splitmix64", baoab_std_splitmix<contraction::off>);

  const mclachlan2 two_stage;
  add_stepper("two-stage, O at the end",
              make_stepper(chain, thermostat(two_stage, placement::end), h, counter_noise(1)));
  add_stepper("two-stage, O symmetric",
              make_stepper(chain, thermostat(two_stage, placement::symmetric), h, counter_noise(1)));
  add_stepper("two-stage, no bath", make_stepper(chain.base(), two_stage, h));
  runners.push_back({"noise alone", static_cast<double>(trajectories * steps), draw_noise});
  race("langevin", std::move(runners));
}

}  // namespace nysalt::bench
