// SPDX-License-Identifier: BSL-1.0
// The options in the provenance of a result.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace nysalt::program {

/// Options as they were given, lists taken apart: TOML, as this program wrote it.
class recorded_options {
 public:
  explicit recorded_options(const std::string& toml);

  const std::string& command() const { return command_; }
  /// Names and values, of a list one after the other.
  const std::vector<std::pair<std::string, std::string>>& all() const { return all_; }
  std::vector<std::string> of(const std::string& option) const;
  std::string one_of(const std::string& option, const std::string& otherwise) const;
  bool is_positive(const std::string& option) const;

 private:
  std::string command_;
  std::vector<std::pair<std::string, std::string>> all_;
};

}  // namespace nysalt::program
