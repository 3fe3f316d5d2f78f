// SPDX-License-Identifier: BSL-1.0
// Known methods by their coefficients.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nysalt/letters.hpp"
#include "nysalt/method.hpp"

namespace nysalt::program {

/// The name of the first of `known` whose map the method's is: "verlet", or "verlet, 3 steps in one" where it
/// is several equal steps of it; nothing if it is none. Words are compared without letters of coefficient
/// zero, with neighbours that act as one joined, and with a kick for a gradient kick that has no gradient
/// part. Coefficients are the same if they differ by less than 1e-6: that changes an error by as little.
std::optional<std::string> known_as(const method& method, std::span<const nysalt::method> known);

/// The same among the classical methods, and the members of a family that are written down: the classical
/// ones, the most stable member, and the start of its searches, "pefrl in r_aba4" or "the start of r_aba2".
/// theta is of that family.
std::optional<std::string> known_as(const std::string& family, const std::vector<double>& theta,
                                    std::span<const nysalt::method> further = {},
                                    const std::vector<letter_facts>& of_system = {});

}  // namespace nysalt::program
