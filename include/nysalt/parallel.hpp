// SPDX-License-Identifier: BSL-1.0
// Ensembles and large systems over threads and processes; nysalt/mpi.hpp has the communicator of MPI.
#pragma once

#include "nysalt/communicator.hpp"
#include "nysalt/distributed_run.hpp"
#include "nysalt/ensemble_run.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"
#include "nysalt/shard.hpp"
