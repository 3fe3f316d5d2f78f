// SPDX-License-Identifier: BSL-1.0
#include "json.hpp"

#include <fmt/format.h>

#include <array>
#include <boost/crc.hpp>
#include <fstream>
#include <system_error>

namespace nysalt::program {

std::string text_of(const json& document) {
  return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

json as_kept(const json& document) {
  return json::parse(document.dump(-1, ' ', false, json::error_handler_t::replace));
}

std::string checksum(json document) {
  for (const char* other : {"checksum", "provenance"}) document.erase(other);
  const std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
  boost::crc_32_type crc;
  crc.process_bytes(text.data(), text.size());
  return fmt::format("crc32:{:08x}", crc.checksum());
}

bool may_be_parsed(std::string_view text) {
  constexpr std::size_t most_values = std::size_t{1} << 22U;  // some hundred megabytes of them
  constexpr double most_pairs = 2.5e8;  // of members of one object: each new name is compared with all before
  std::size_t values = 0;
  double pairs = 0.0;
  std::size_t depth = 0;
  std::array<double, deepest_document + 1> members{};  // of the objects that are open
  bool is_in_text = false;
  if (text.size() > longest_document) return false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (is_in_text) {
      if (c == '\\') ++at;
      if (c == '"') is_in_text = false;
    } else if (c == '"') {
      is_in_text = true;
      ++values;
    } else if (c == ',') {
      ++values;
    } else if (c == ':') {
      pairs += members.at(depth)++;
    } else if (c == '[' || c == '{') {
      if (depth == deepest_document) return false;
      members.at(++depth) = 0.0;
      ++values;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return values <= most_values && pairs <= most_pairs;
}

json parsed(std::string_view text) {
  return may_be_parsed(text) ? json::parse(text, nullptr, false) : json(json::value_t::discarded);
}

json document_in(const std::filesystem::path& file, std::size_t most) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure)) return json::value_t::discarded;
  const auto size = std::filesystem::file_size(file, failure);
  if (failure || size > most) return json::value_t::discarded;
  std::ifstream stream(file, std::ios::binary);
  std::string text(static_cast<std::size_t>(size), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return parsed(text);
}

}  // namespace nysalt::program
