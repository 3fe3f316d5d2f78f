// SPDX-License-Identifier: BSL-1.0
// Small damage to a text, as typing, cutting and copying do it.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace nysalt::fuzz {

/// One to four changes at random: bytes flipped, inserted or cut off, lines lost, doubled, swapped or taken
/// from another text, numbers replaced by what is no number, zero or too large, names exchanged.
std::string mutated(std::string text, const std::vector<std::string>& corpus, std::mt19937_64& bits);

}  // namespace nysalt::fuzz
