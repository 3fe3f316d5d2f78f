// SPDX-License-Identifier: BSL-1.0
#include "bibliography.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "bibliography_text.hpp"

namespace nysalt::program {

std::string bibtex_of(std::string_view key) {
  const std::string_view all(bibliography_text);
  const auto name = all.find(fmt::format("{{{},\n", key));
  if (name == std::string_view::npos) throw std::logic_error(fmt::format("unknown work '{}'", key));
  const auto begin = all.rfind('@', name);
  constexpr std::string_view closing = "\n}\n";  // of an entry, at the beginning of its last line
  const auto end = all.find(closing, name) + closing.size() - 1;
  return std::string(all.substr(begin, end - begin));
}

}  // namespace nysalt::program
