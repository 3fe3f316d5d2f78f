// SPDX-License-Identifier: BSL-1.0
// Methods on disk: learned schemes, and users' own coefficient tables.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bundled_system.hpp"
#include "json.hpp"
#include "nysalt/methods/tabulated.hpp"

namespace nysalt::program {

/// What a scheme file says: a family's parameters, and where they are valid.
struct scheme {
  tabulated method;  // under the family's name
  double step;
  std::string system;  // its description
  bool usable;
  std::string reason;
};

/// The file's text: what was learned, how well, and from what; with a checksum, and nothing of the machine or
/// the hour, so that equal runs write equal bytes.
std::string scheme_text(const learned_scheme& learned, const bundled_system& system, const learn_plan& plan);

struct method_file {
  std::optional<scheme> learned;   // one of the two
  std::optional<tabulated> table;  // its order was found from its coefficients
};

/// Reads either kind. Throws refusal, naming the file, for one that is missing, not whole, edited, foreign or
/// of a newer version, and for coefficients that are not consistent or of a lower order than declared.
method_file read_method_file(const std::filesystem::path& path);

}  // namespace nysalt::program
