// SPDX-License-Identifier: BSL-1.0
#include "command_text.hpp"

namespace nysalt::program {

std::string command_text(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain =
        !argument.empty() && argument.find_first_of(" '\"\\$&|;<>()*?#~\n\t") == std::string::npos;
    if (i > 0) text += ' ';
    if (plain) {
      text += argument;
    } else {
      text += '\'';
      for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
      text += '\'';
    }
  }
  return text;
}

}  // namespace nysalt::program
