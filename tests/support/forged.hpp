// SPDX-License-Identifier: BSL-1.0
// Scheme files and lines of work files that somebody has changed and signed again.
#pragma once

#include <boost/crc.hpp>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace nysalt::test {

/// The CRC-32 of a text, in eight digits.
inline std::string digits_of_crc(const std::string& text) {
  boost::crc_32_type sum;
  sum.process_bytes(text.data(), text.size());
  char digits[9];
  std::snprintf(digits, sizeof digits, "%08x", static_cast<unsigned>(sum.checksum()));
  return digits;
}

/// A line of a work file, an object without spaces, with the checksum that it ought to end with.
inline std::string signed_line(const std::string& line) {
  std::string bare = line.substr(0, line.rfind(",\"checksum\":"));
  if (bare.size() == line.size()) bare.pop_back();
  return bare + ",\"checksum\":\"crc32:" + digits_of_crc(bare + "}") + "\"}";
}

/// A scheme file's text after a change to its document, under a checksum that fits again.
inline std::string forged(const std::string& text,
                          const std::function<void(nlohmann::ordered_json&)>& change) {
  auto document = nlohmann::ordered_json::parse(text);
  change(document);
  for (const char* other : {"checksum", "provenance"}) document.erase(other);  // the checksum is of neither
  document["checksum"] = "crc32:" + digits_of_crc(document.dump());
  return document.dump(2);
}

}  // namespace nysalt::test
