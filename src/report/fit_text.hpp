// SPDX-License-Identifier: BSL-1.0
// Fits in some lines, the verdict first.
#pragma once

#include <string>
#include <vector>

#include "comparison/settings.hpp"
#include "nysalt/learning/fit_summary.hpp"

namespace nysalt::program {

/// Whether a fit is usable, and what was gained by it or why not: one sentence.
std::string verdict_sentence(const fit_summary& fit);

/// The sentence, and below it the parameters with all digits and what matters of their origin.
std::string text_of(const fit_summary& fit, const text_form& form);

/// How many of the steps are usable, and a row and the parameters of each. There must be a fit.
std::string text_of(const std::vector<fit_summary>& curve, const text_form& form);

}  // namespace nysalt::program
