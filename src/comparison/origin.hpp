// SPDX-License-Identifier: BSL-1.0
// What decides the last digits of a result beside what was asked: the program, and the functions of the C
// library, which choose their code by the processor.
#pragma once

#include <filesystem>
#include <string>

#include "json.hpp"

namespace nysalt::program {

/// What a file that a later run goes on from says of who wrote it: `nysalt`, the version, and `functions`,
/// the CRC-32 of what exp, sin and their like return at 2000 arguments each. Cost: a millisecond at the first
/// call.
json origin();

/// What is to be said of going on with a file whose head, a JSON object, has another origin; empty where that
/// is the same, or where an older version did not say.
std::string warning_of_origin(const json& head, const std::filesystem::path& file);

}  // namespace nysalt::program
