// SPDX-License-Identifier: BSL-1.0
// The methods that are tried.
#pragma once

#include <string>
#include <vector>

#include "energy_story.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/methods/classical.hpp"

namespace nysalt::hard {

/// Every named method of drifts and kicks, two with gradient kicks among them; s_aia2 for z up to 2.
std::vector<method> classical_words();

/// (1/2, 0.4): stable for z in 0 .. 2.58 and again in 3.16 .. 4.08.
method nystrom_with_two_windows();

/// Members of families: learned ones, and one of two windows.
std::vector<method> learned_words();

/// What was learned once, see the source.
method learned_fg4_for_fpu();
method learned_fg4_for_kepler();
method learned_fg4_for_henon_heiles();
method learned_r_aba4_at_resonance(int k);

/// The classical ones that tell most, cheap to dear, and a learned one.
std::vector<contender> side_by_side(const method& learned);

}  // namespace nysalt::hard
