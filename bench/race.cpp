// SPDX-License-Identifier: BSL-1.0
#include "race.hpp"

#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <time.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <utility>

namespace nysalt::bench {

namespace {

double now(clock_kind kind) {
  if (kind == clock_kind::children) {
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
  }
  timespec t{};
  clock_gettime(kind == clock_kind::own_processor ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

class rounds {
 public:
  rounds(std::vector<runner> runners, const race_options& options)
      : runners_(std::move(runners)), options_(options) {}

  void operator()(benchmark::State& state) {
    try {
      go(state);
    } catch (const std::exception& problem) {
      state.SkipWithError(problem.what());
    }
  }

 private:
  void go(benchmark::State& state) {
    if (turns_.empty()) calibrate();
    const bool once = options_.turn_seconds == 0.0;
    for (auto _ : state) {
      std::vector<double> seconds(runners_.size(), 0.0);
      for (std::size_t j = 0; j < runners_.size(); ++j) seconds[j] += seconds_of(runners_[j], turns_[j]);
      for (std::size_t j = runners_.size(); j-- > 0 && !once;)
        seconds[j] += seconds_of(runners_[j], turns_[j]);
      double sum = 0.0;
      for (std::size_t j = 0; j < runners_.size(); ++j) {
        const double work = (once ? 1.0 : 2.0) * static_cast<double>(turns_[j]) * runners_[j].work;
        state.counters["ns/" + runners_[j].name] = 1e9 * seconds[j] / work;
        sum += seconds[j];
      }
      state.SetIterationTime(sum);
    }
  }

  double seconds_of(const runner& who, std::int64_t turns) const {
    const double began = now(options_.clock);
    for (std::int64_t n = 0; n < turns; ++n) who.turn();
    return now(options_.clock) - began;
  }

  /// The first turns, uncounted, also warm up caches and clocks.
  void calibrate() {
    for (const runner& who : runners_) {
      std::int64_t turns = 1;
      if (options_.turn_seconds == 0.0) {
        turns_.push_back(turns);
        continue;
      }
      for (double seconds = seconds_of(who, turns); seconds < options_.turn_seconds;) {
        turns =
            1 + static_cast<std::int64_t>(static_cast<double>(turns) * 1.2 * options_.turn_seconds / seconds);
        seconds = seconds_of(who, turns);
      }
      turns_.push_back(turns);
    }
  }

  std::vector<runner> runners_;
  race_options options_;
  std::vector<std::int64_t> turns_;
};

}  // namespace

void race(const std::string& name, std::vector<runner> runners, const race_options& options) {
  const auto body = std::make_shared<rounds>(std::move(runners), options);
  auto* const made = benchmark::RegisterBenchmark(name.c_str(), [body](benchmark::State& s) { (*body)(s); });
  made->Iterations(1)->UseManualTime();
  if (options.repetitions > 0) made->Repetitions(options.repetitions);
}

}  // namespace nysalt::bench
