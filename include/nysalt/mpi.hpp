// SPDX-License-Identifier: BSL-1.0
// What needs MPI: processes that share an ensemble.
#pragma once

#include "nysalt/communicators/mpi.hpp"
