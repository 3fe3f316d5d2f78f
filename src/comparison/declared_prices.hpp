// SPDX-License-Identifier: BSL-1.0
// What a step costs where parts of the force have prices.
#pragma once

#include <vector>

#include "nysalt/word.hpp"

namespace nysalt::program {

/// Throws refusal unless there is a finite price >= 0 for each part that letters of the system kick with, and
/// one of the prices is positive.
void require_sound_prices(const std::vector<double>& prices, const std::vector<letter_facts>& of_system);

/// The cost of a step in evaluations of the whole force, whose price is the sum of the prices: a kick with
/// part i costs prices[i] / sum, every other evaluation one. Without prices each kick costs one.
double priced_evaluations(const word& letters, const std::vector<double>& prices);

}  // namespace nysalt::program
