// SPDX-License-Identifier: BSL-1.0
// Who is compared takes turns: a machine that slows down slows all of them, and a ratio stays what it is.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace nysalt::bench {

/// `turn` does `work` units of work: trajectory-steps, numbers, samples.
struct runner {
  std::string name;
  double work;
  std::function<void()> turn;
};

/// One thread is timed by what it had of the processor, so that others on the machine take less part; several
/// threads by the clock on the wall; other programs by what they had.
enum class clock_kind { own_processor, wall, children };

struct race_options {
  double turn_seconds = 0.005;  // a turn is repeated for at least so long; 0: one turn a round
  int repetitions = 0;          // 0: as the command line says
  clock_kind clock = clock_kind::own_processor;
};

/// Makes a google-benchmark of the runners. One repetition is one round: each has its turn, and then each
/// again in the opposite order, so that a steady drift of the machine's speed cancels. What it tells of each
/// runner is the counter "ns/NAME", nanoseconds for a unit of work: one paired sample for a repetition.
void race(const std::string& name, std::vector<runner> runners, const race_options& options = {});

}  // namespace nysalt::bench
