// SPDX-License-Identifier: BSL-1.0
// JSON with its keys in the order in which they were written.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace nysalt::program {

using json = nlohmann::ordered_json;

/// For people and files; bytes that are no UTF-8, as names of files may hold, become U+FFFD.
std::string text_of(const json& document);

/// The document as it is read again from a file, where bytes that are no UTF-8 became U+FFFD.
json as_kept(const json& document);

}  // namespace nysalt::program
