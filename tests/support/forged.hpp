// SPDX-License-Identifier: BSL-1.0
// Scheme files that somebody has changed and signed again.
#pragma once

#include <boost/crc.hpp>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace nysalt::test {

/// The file's text after a change to its document, under a checksum that fits again.
inline std::string forged(const std::string& text,
                          const std::function<void(nlohmann::ordered_json&)>& change) {
  auto document = nlohmann::ordered_json::parse(text);
  change(document);
  document.erase("checksum");
  const std::string bare = document.dump();
  boost::crc_32_type crc;
  crc.process_bytes(bare.data(), bare.size());
  char digits[16];
  std::snprintf(digits, sizeof digits, "crc32:%08x", static_cast<unsigned>(crc.checksum()));
  document["checksum"] = digits;
  return document.dump(2);
}

}  // namespace nysalt::test
