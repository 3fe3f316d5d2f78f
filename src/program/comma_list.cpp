// SPDX-License-Identifier: BSL-1.0
#include "comma_list.hpp"

#include "comparison/number.hpp"
#include "comparison/refusal.hpp"

namespace nysalt::program {

std::vector<std::string> split_at_commas(std::string_view text) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t comma = 0; comma != std::string_view::npos; from = comma + 1) {
    comma = text.find(',', from);
    parts.emplace_back(text.substr(from, comma - from));
  }
  return parts;
}

std::vector<std::string> entries_of(const std::vector<std::string>& texts, const char* option) {
  std::vector<std::string> entries;
  for (const auto& text : texts) {
    for (const auto& entry : split_at_commas(text)) {
      if (entry.empty()) refuse("{} must have no empty entry, got '{}'", option, text);
      entries.push_back(entry);
    }
  }
  return entries;
}

std::vector<double> numbers_of(const std::vector<std::string>& texts, const char* option) {
  std::vector<double> values;
  for (const auto& entry : entries_of(texts, option)) values.push_back(number_of<double>(option, entry));
  return values;
}

}  // namespace nysalt::program
