// SPDX-License-Identifier: BSL-1.0
// Common parts of files of schemes and tables, to read and to write.
#pragma once

namespace nysalt::program {

inline constexpr int known_version = 1;
inline constexpr int with_placement = 2;  // of a scheme that says where its letters O are
inline constexpr int as_curve = 3;        // of a scheme with several steps, perhaps with a placement
inline constexpr const char* scheme_format = "nysalt scheme";
inline constexpr const char* table_format = "nysalt table";

}  // namespace nysalt::program
