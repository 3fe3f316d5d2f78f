// SPDX-License-Identifier: BSL-1.0
// What a method is learned for: one rule for the loss, in every command.
#pragma once

#include <string>

#include "nysalt/bath.hpp"
#include "nysalt/comparison_options.hpp"

namespace nysalt::program {

inline constexpr const char* for_state = "state";
inline constexpr const char* for_energy = "energy";
inline constexpr const char* for_distribution = "distribution";
inline constexpr const char* for_sampling = "sampling";

/// "learned for state, by the loss trajectory"
std::string report_of_purpose(const learning_options& how);

/// "state, energy, distribution, sampling"
std::string purposes();

/// Names the loss that the purpose sets, `usual` where no purpose is asked for. Where a loss is asked for it
/// says what is learned for, and the purpose becomes empty. `prefix` is that of the names of learning. Throws
/// refusal for an unknown purpose, and for sampling without a horizon, as that is of the proposals and not of
/// the step.
void settle_purpose(learning_options& how, const bath& around, const std::string& prefix,
                    const char* usual = for_state);

}  // namespace nysalt::program
