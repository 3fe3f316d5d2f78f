// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace nysalt {

inline constexpr const char* version = "0.1.0";  ///< version of the headers; the build reads it here

}  // namespace nysalt
