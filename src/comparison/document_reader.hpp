// SPDX-License-Identifier: BSL-1.0
// JSON documents that people may have edited.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "json.hpp"
#include "refusal.hpp"

namespace nysalt::program {

/// Members of a JSON object, each of its type, or a refusal that names file and member.
class document_reader {
 public:
  document_reader(const json& document, std::string file) : document_(document), file_(std::move(file)) {}

  const json& member(const char* key) const {
    if (!document_.contains(key)) refuse("{} must have the member \"{}\", got none", file_, key);
    return document_[key];
  }
  std::string text(const char* key) const {
    if (!member(key).is_string()) refuse("{}: \"{}\" must be a text", file_, key);
    return member(key).get<std::string>();
  }
  double number(const char* key) const { return number(member(key), key); }
  double number(const json& value, const char* key) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      refuse("{}: \"{}\" must hold finite numbers", file_, key);
    }
    return value.get<double>();
  }
  std::vector<double> numbers(const char* key) const {
    if (!member(key).is_array()) refuse("{}: \"{}\" must be a list of numbers", file_, key);
    std::vector<double> result;
    for (const auto& value : member(key)) result.push_back(number(value, key));
    return result;
  }
  bool flag(const char* key) const {
    if (!member(key).is_boolean()) refuse("{}: \"{}\" must be true or false", file_, key);
    return member(key).get<bool>();
  }
  const std::string& file() const { return file_; }

 private:
  const json& document_;
  std::string file_;
};

}  // namespace nysalt::program
