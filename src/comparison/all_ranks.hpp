// SPDX-License-Identifier: BSL-1.0
// Those who compute together: one process, or the ranks that mpirun started.
#pragma once

#include "nysalt/communicator.hpp"

namespace nysalt::program {

/// One process by itself, until it has joined others.
const communicator& all_ranks();

/// All that computes from now on does so together with these ranks; to be called while nothing computes.
void join(const communicator& ranks);

/// Rank 0 speaks and writes for all.
inline bool speaks_for_all() { return all_ranks().is_first(); }

/// Whether a line of progress would be seen: standard error is a terminal, or that of mpirun beside us is.
bool has_terminal();

}  // namespace nysalt::program
