// SPDX-License-Identifier: BSL-1.0
#include "recorded_options.hpp"

#include "comma_list.hpp"
#include "comparison/number.hpp"
#include "toml_options.hpp"

namespace nysalt::program {

recorded_options::recorded_options(const std::string& toml) {
  for (const auto& option : options_in_toml(toml, "options")) {
    if (!option.section.empty()) command_ = option.section;
    for (const auto& joined : option.values) {
      for (const auto& one : split_at_commas(joined)) all_.emplace_back(option.name, one);
    }
  }
}

std::vector<std::string> recorded_options::of(const std::string& option) const {
  std::vector<std::string> values;
  for (const auto& [name, value] : all_) {
    if (name == option) values.push_back(value);
  }
  return values;
}

std::string recorded_options::one_of(const std::string& option, const std::string& otherwise) const {
  const auto values = of(option);
  return values.empty() ? otherwise : values.front();
}

bool recorded_options::is_positive(const std::string& option) const {
  return number_from(one_of(option, "0")).value_or(0.0) > 0.0;
}

}  // namespace nysalt::program
