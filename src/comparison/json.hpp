// SPDX-License-Identifier: BSL-1.0
// JSON with its keys in the order in which they were written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace nysalt::program {

using json = nlohmann::ordered_json;

/// For people and files; bytes that are no UTF-8, as names of files may hold, become U+FFFD.
std::string text_of(const json& document);

/// The document as it is read again from a file, where bytes that are no UTF-8 became U+FFFD.
json as_kept(const json& document);

/// Of every member of a document but those named checksum and provenance, as the document would be written
/// without spaces.
std::string checksum(json document);

/// Of lists and objects in each other, in documents that are read.
constexpr int deepest_document = 64;
/// Bytes of a document that is read: many times those of the longest that the program writes.
constexpr std::size_t longest_document = std::size_t{1} << 26U;

/// Whether a text is short and flat enough to be parsed, copied and destroyed in some seconds and less than a
/// gigabyte: at most longest_document bytes, deepest_document lists or objects in each other, and not too
/// many values. All JSON from outside must pass here before it is parsed.
bool may_be_parsed(std::string_view text);

/// The document in a text from outside. Discarded (is_discarded()) if the text is no JSON, or may not be
/// parsed.
json parsed(std::string_view text);

/// The document in a file. Discarded if there is none, as in a device or FIFO, which are not opened, or if
/// the file has more than `most` bytes.
json document_in(const std::filesystem::path& file, std::size_t most = longest_document);

}  // namespace nysalt::program
