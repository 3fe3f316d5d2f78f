// SPDX-License-Identifier: BSL-1.0
// Lists as they are typed: joined by commas, in one text or several.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nysalt::program {

/// The texts between the commas; the whole text if there is none.
std::vector<std::string> split_at_commas(std::string_view text);

/// "a,b" and "c" become a, b, c. Throws refusal, naming the option, for an empty entry.
std::vector<std::string> entries_of(const std::vector<std::string>& texts, const char* option);

/// The same of numbers. Throws refusal also for what is not a finite number.
std::vector<double> numbers_of(const std::vector<std::string>& texts, const char* option);

}  // namespace nysalt::program
