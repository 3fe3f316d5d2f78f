// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"

namespace nysalt::program {

/// Starts with the positions of a CSV file, which names its columns in the first line and has q1, q2, ... of
/// the system among them, as `sample` writes it. Throws refusal if it cannot be read or does not fit.
initial_states starts_in(const std::string& file, const model& system, double temperature);

}  // namespace nysalt::program
