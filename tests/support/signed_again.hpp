// SPDX-License-Identifier: BSL-1.0
// Checkpoints that somebody has changed and signed again.
#pragma once

#include <boost/crc.hpp>
#include <cstdio>
#include <string>

namespace nysalt::test {

/// The text with the sum that it ought to end with.
inline std::string signed_again(const std::string& text) {
  const std::string bare = text.substr(0, text.rfind("\ncrc32 "));
  boost::crc_32_type sum;
  sum.process_bytes(bare.data(), bare.size());
  char line[20];
  std::snprintf(line, sizeof line, "\ncrc32 %08x\n", static_cast<unsigned>(sum.checksum()));
  return bare + line;
}

}  // namespace nysalt::test
