// SPDX-License-Identifier: BSL-1.0
#include "race.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

namespace nysalt::bench {

namespace {

double seconds_of(const runner& who, std::int64_t turns) {
  const auto began = std::chrono::steady_clock::now();
  for (std::int64_t n = 0; n < turns; ++n) who.turn();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

class rounds {
 public:
  rounds(std::vector<runner> runners, double turn_seconds)
      : runners_(std::move(runners)), turn_seconds_(turn_seconds) {}

  void operator()(benchmark::State& state) {
    if (turns_.empty()) calibrate();
    for (auto _ : state) {
      std::vector<double> seconds(runners_.size(), 0.0);
      for (std::size_t j = 0; j < runners_.size(); ++j) seconds[j] += seconds_of(runners_[j], turns_[j]);
      for (std::size_t j = runners_.size(); j-- > 0;) seconds[j] += seconds_of(runners_[j], turns_[j]);
      double sum = 0.0;
      for (std::size_t j = 0; j < runners_.size(); ++j) {
        const double work = 2.0 * static_cast<double>(turns_[j]) * runners_[j].work;
        state.counters["ns/" + runners_[j].name] = 1e9 * seconds[j] / work;
        sum += seconds[j];
      }
      state.SetIterationTime(sum);
    }
  }

 private:
  /// The first turns, uncounted, also warm up caches and clocks.
  void calibrate() {
    for (const runner& who : runners_) {
      std::int64_t turns = 1;
      for (double seconds = seconds_of(who, turns); seconds < turn_seconds_;) {
        turns = 1 + static_cast<std::int64_t>(static_cast<double>(turns) * 1.2 * turn_seconds_ / seconds);
        seconds = seconds_of(who, turns);
      }
      turns_.push_back(turns);
    }
  }

  std::vector<runner> runners_;
  double turn_seconds_;
  std::vector<std::int64_t> turns_;
};

}  // namespace

void race(const std::string& name, std::vector<runner> runners, const race_options& options) {
  const auto body = std::make_shared<rounds>(std::move(runners), options.turn_seconds);
  auto* const made = benchmark::RegisterBenchmark(name.c_str(), [body](benchmark::State& s) { (*body)(s); });
  made->Iterations(1)->UseManualTime();
  if (options.repetitions > 0) made->Repetitions(options.repetitions);
}

}  // namespace nysalt::bench
