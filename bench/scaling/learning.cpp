// SPDX-License-Identifier: BSL-1.0
// Learning over ranks: making the data, a pass over them, the whole; and what memory it takes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../../src/nysalt/learning/problem.hpp"
#include "measure.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "sizes.hpp"

namespace nysalt::bench {

namespace {

constexpr double h = 0.01;
constexpr std::int64_t steps = 16;  // of a trajectory, each a pair
const fpu_chain<3> chain(50.0);

using data_type = flow_map_data;

data_type make_data(const size_of_work& size, std::uint64_t seed) {
  return make_flow_map_data(chain, fpu_law<3>(chain), fine_steps(1e-3),
                            {.step = h,
                             .horizon = h * static_cast<double>(size.steps),
                             .trajectories = size.trajectories,
                             .seed = seed,
                             .execution = {.threads = size.threads, .ranks = &size.who->ranks()}});
}

/// Data and what is made of them, ready to be gone through.
struct learning_case {
  data_type data;
  data_type held_out;
  learning_problem problem;

  explicit learning_case(const size_of_work& size)
      : data(make_data(size, 1)),
        held_out(make_data(size, 2)),
        problem(family(nystrom{}), chain, data, held_out, {.execution = {.threads = size.threads}}) {}

  double loss() const { return problem.loss(problem.family.starts.front().theta).value; }
};

/// What ranks and threads find must not depend on them: else something else was timed.
void require_same(std::map<std::int64_t, double>& seen, std::int64_t trajectories, double loss) {
  if (seen.emplace(trajectories, loss).first->second == loss) return;
  throw std::runtime_error("the loss depends on who computed it");
}

/// Largest memory that the process has had so far, in bytes.
std::int64_t peak_memory() {
  std::ifstream file("/proc/self/status");
  const std::string key = "VmHWM:";
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(key)) return 1024 * std::stoll(line.substr(key.size()));  // in kB
  }
  throw std::runtime_error("/proc/self/status has no VmHWM");
}

void race_data(const std::deque<first_ranks>& all, std::int64_t trajectories, int rounds) {
  auto sizes = strong_and_weak(all, trajectories, steps);
  for (const int part : {64, 16, 4}) {
    sizes.push_back({"size", &all.front(), 1, trajectories / part, steps});
  }
  std::vector<runner> runners;
  for (const auto& size : sizes) {
    runners.push_back({row_of("data", size), size.who, [size] { make_data(size, 1); }});
  }
  take_turns(runners, rounds);
}

void race_passes(const std::deque<first_ranks>& all, std::int64_t trajectories, int rounds) {
  auto sizes = strong_and_weak(all, trajectories, steps);
  for (const int part : {64, 16, 4}) {
    sizes.push_back({"size", &all.front(), 1, trajectories / part, steps});
  }
  std::map<std::int64_t, double> seen;
  std::vector<runner> runners;
  for (const auto& size : sizes) {
    const auto prepared_case = size.who->take_part() ? std::make_shared<learning_case>(size) : nullptr;
    wait_for_all();
    const int times = static_cast<int>(std::max<std::int64_t>(4, 8 * trajectories / size.trajectories));
    runners.push_back({row_of("pass", size), size.who,
                       [prepared_case, times, size, &seen] {
                         for (int n = 0; n < times; ++n)
                           require_same(seen, size.trajectories, prepared_case->loss());
                       },
                       times});
  }
  take_turns(runners, rounds);
}

void race_learning(const std::deque<first_ranks>& all, std::int64_t trajectories, int rounds) {
  auto sizes = strong_and_weak(all, trajectories, steps);
  for (const int part : {16, 4}) {
    sizes.push_back({"size", &all.front(), 1, trajectories / part, steps});
  }
  std::map<std::int64_t, double> seen;
  std::vector<runner> runners;
  for (const auto& size : sizes) {
    using both = std::pair<data_type, data_type>;
    const auto data_sets =
        size.who->take_part() ? std::make_shared<both>(make_data(size, 1), make_data(size, 2)) : nullptr;
    wait_for_all();
    runners.push_back({row_of("learn", size), size.who, [data_sets, size, &seen] {
                         const auto found = learn(nystrom{}, chain, data_sets->first, data_sets->second,
                                                  {.execution = {.threads = size.threads}});
                         require_same(seen, size.trajectories, found.summary.loss);
                       }});
  }
  take_turns(runners, rounds);
}

}  // namespace

void measure_learning() {
  const auto all = numbers_of_ranks();
  race_data(all, 2048, 11);
  race_passes(all, 8192, 21);
  race_learning(all, 2048, 5);
}

void measure_memory(std::int64_t trajectories, std::int64_t of_steps) {
  const first_ranks all(size_of_job());
  const std::int64_t before = peak_memory();
  const learning_case prepared_case({"memory", &all, 1, trajectories, of_steps});
  prepared_case.loss();
  struct of_rank {
    std::int64_t trajectories;
    std::int64_t before;
    std::int64_t bytes;
  };
  const auto here = static_cast<std::int64_t>(prepared_case.data.trajectories());
  const auto of_all = all_gather(all.ranks(), of_rank{here, before, peak_memory()});
  for (std::size_t r = 0; r < of_all.size(); ++r) {
    print_row({{"what", "memory"},
               {"ranks", all.size()},
               {"rank", r},
               {"trajectories", trajectories},
               {"steps", of_steps},
               {"share", of_all[r].trajectories},
               {"bytes_before", of_all[r].before},
               {"bytes", of_all[r].bytes}});
  }
}

}  // namespace nysalt::bench
