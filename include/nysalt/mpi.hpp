// SPDX-License-Identifier: BSL-1.0
// The part of the library that needs MPI: processes that share an ensemble.
#pragma once

#include "nysalt/communicators/mpi.hpp"
