// SPDX-License-Identifier: BSL-1.0
// How plug-ins are compiled: as nysalt was.
#pragma once

#include <string>
#include <vector>

namespace nysalt::program {

/// The compiler and its arguments, and what is linked.
struct recipe {
  std::vector<std::string> before;
  std::vector<std::string> libraries;
};

/// The recipe of the build folder or of the installed tree that this code was loaded from, and of no other
/// folder: who may write a folder above would decide what runs. Throws refusal if there is none.
recipe recipe_of_library();

}  // namespace nysalt::program
