// SPDX-License-Identifier: BSL-1.0
// Every race; each checks that its runners reach the same end, and throws std::runtime_error if not.
#pragma once

#include "race.hpp"

namespace nysalt::bench {

void race_ensemble();
void race_single_trajectory();
void race_words();
void race_long_chain();
void race_liquid();
void race_growth();
void race_noise();
void race_langevin();
void race_heaviest_run();
void race_learning();
void race_learning_pass();
void race_threads();
void race_one_chain();
void race_compiling();

}  // namespace nysalt::bench
