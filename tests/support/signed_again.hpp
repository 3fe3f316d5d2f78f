// SPDX-License-Identifier: BSL-1.0
// Checkpoints and lines of journals that somebody has changed and signed again.
#pragma once

#include <boost/crc.hpp>
#include <cstdio>
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

/// A checkpoint with the sum that it ought to end with.
inline std::string signed_again(const std::string& text) {
  const std::string bare = text.substr(0, text.rfind("\ncrc32 "));
  return bare + "\ncrc32 " + digits_of_crc(bare) + "\n";
}

/// A line of a journal, an object without spaces, with the checksum that it ought to end with.
inline std::string signed_line(const std::string& line) {
  std::string bare = line.substr(0, line.rfind(",\"checksum\":"));
  if (bare.size() == line.size()) bare.pop_back();
  return bare + ",\"checksum\":\"crc32:" + digits_of_crc(bare + "}") + "\"}";
}

}  // namespace nysalt::test
